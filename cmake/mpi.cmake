# SPDX-License-Identifier: Apache-2.0
# zoneplate-mpi, a program of its own: `zoneplate` needs no MPI. Only MPI's C interface is used.
find_package(MPI REQUIRED COMPONENTS CXX)
add_executable(zoneplate_mpi EXCLUDE_FROM_ALL mpi/main.cpp mpi/mpi_ranks.cpp)
set_target_properties(zoneplate_mpi PROPERTIES OUTPUT_NAME zoneplate-mpi)
target_compile_definitions(zoneplate_mpi PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
target_link_libraries(zoneplate_mpi PRIVATE zoneplate_cli MPI::MPI_CXX)
harden(zoneplate_mpi)
