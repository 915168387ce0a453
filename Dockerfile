# SPDX-License-Identifier: Apache-2.0
# The command in a container, from Debian's packages alone:
#
#   docker build -t zoneplate .
#   docker run --rm --read-only --network none -v "$PWD:/work" zoneplate chair.glb -o chair.png
#
# The program runs as nobody and needs no place to write but that of its output; for a folder of your own, add
# --user "$(id -u):$(id -g)".
FROM debian:12-slim AS build
COPY . /source
WORKDIR /source
RUN apt-get update && ./zoneplate list methods && cmake --build build/release --target packages

FROM debian:12-slim
COPY --from=build /source/build/release/packages/*.deb /tmp/
RUN apt-get update && apt-get install --yes --no-install-recommends /tmp/*.deb fonts-dejavu-core \
    libopenexr-3-1-30 liblcms2-2 libtiff6 libavif15 libjxl0.7 libzstd1 libmeshoptimizer2d libassimp5 \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
USER nobody
WORKDIR /work
ENTRYPOINT ["zoneplate"]
