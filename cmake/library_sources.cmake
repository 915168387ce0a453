# SPDX-License-Identifier: Apache-2.0
# The codecs of Debian's libraries, compiled for this target from their sources, which APT fetches when they are built
# (library_sources.sh): PNG, JPEG, WebP, Deflate, ZIP, XML, and meshoptimizer's buffers. Images have the codes of the
# program's own.
enable_language(C)
set(sources_folder ${CMAKE_CURRENT_BINARY_DIR}/libraries)
set(codec_sources "")
# Appends sources, given without their endings.
function(add_codec folder ending)
  foreach(name IN LISTS ARGN)
    list(APPEND codec_sources ${sources_folder}/${folder}/${name}.${ending})
  endforeach()
  set(codec_sources ${codec_sources} PARENT_SCOPE)
endfunction()
add_codec(zlib c adler32 compress crc32 deflate inffast inflate inftrees trees uncompr zutil)
add_codec(zlib/contrib/minizip c ioapi unzip)
add_codec(expat/expat/lib c xmlparse xmlrole xmltok)
add_codec(libpng1.6 c png pngerror pngget pngmem pngpread pngread pngrio pngrtran pngrutil pngset pngtrans pngwio pngwrite pngwtran pngwutil)
add_codec(libjpeg-turbo c jaricom jcapimin jcapistd jcarith jccoefct jccolor jcdctmgr jchuff jcicc jcinit jcmainct jcmarker jcmaster jcomapi
          jcparam jcphuff jcprepct jcsample jctrans jdapimin jdapistd jdarith jdatadst jdatasrc jdcoefct jdcolor jddctmgr jdhuff jdicc jdinput
          jdmainct jdmarker jdmaster jdmerge jdphuff jdpostct jdsample jdtrans jerror jfdctflt jfdctfst jfdctint jidctflt jidctfst jidctint
          jidctred jmemmgr jmemnobs jquant1 jquant2 jsimd_none jutils)
add_codec(libwebp/src/dec c alpha_dec buffer_dec frame_dec idec_dec io_dec quant_dec tree_dec vp8_dec vp8l_dec webp_dec)
add_codec(libwebp/src/enc c alpha_enc analysis_enc backward_references_cost_enc backward_references_enc config_enc cost_enc filter_enc frame_enc
          histogram_enc iterator_enc near_lossless_enc picture_csp_enc picture_enc picture_psnr_enc picture_rescale_enc picture_tools_enc
          predictor_enc quant_enc syntax_enc token_enc tree_enc vp8l_enc webp_enc)
add_codec(libwebp/src/dsp c alpha_processing cost cpu dec dec_clip_tables enc filters lossless lossless_enc rescaler ssim upsampling yuv)
add_codec(libwebp/sharpyuv c sharpyuv sharpyuv_csp sharpyuv_dsp sharpyuv_gamma)
add_codec(libwebp/src/utils c bit_reader_utils bit_writer_utils color_cache_utils filters_utils huffman_encode_utils huffman_utils
          quant_levels_dec_utils quant_levels_utils random_utils rescaler_utils thread_utils utils)
add_codec(libwebp/src/mux c anim_encode muxedit muxinternal muxread)
add_codec(libwebp/src/demux c anim_decode demux)
add_codec(meshoptimizer/src cpp allocator indexcodec vertexcodec vertexfilter)

add_custom_command(OUTPUT ${codec_sources} ${sources_folder}/libpng1.6/pnglibconf.h
                   COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cmake/library_sources.sh ${sources_folder} zlib libpng1.6 libjpeg-turbo libwebp expat meshoptimizer
                   COMMAND ${CMAKE_COMMAND} -E copy ${sources_folder}/libpng1.6/scripts/pnglibconf.h.prebuilt ${sources_folder}/libpng1.6/pnglibconf.h
                   COMMENT "Fetching the sources of libraries with APT" VERBATIM)
# What the libraries' own builds find out about the compiler.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/codec_headers/jconfigint.h "#define BUILD \"\"\n#define INLINE inline\n#define THREAD_LOCAL\n\
#define PACKAGE_NAME \"libjpeg-turbo\"\n#define VERSION \"\"\n#define SIZEOF_SIZE_T ${CMAKE_SIZEOF_VOID_P}\n#define FALLTHROUGH\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/codec_headers/jconfig.h "#define JPEG_LIB_VERSION 62\n#define LIBJPEG_TURBO_VERSION 0\n\
#define LIBJPEG_TURBO_VERSION_NUMBER 0\n#define C_ARITH_CODING_SUPPORTED 1\n#define D_ARITH_CODING_SUPPORTED 1\n\
#define MEM_SRCDST_SUPPORTED 1\n#define BITS_IN_JSAMPLE 8\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/codec_headers/jversion.h "#define JVERSION \"\"\n#define JCOPYRIGHT \"\"\n#define JCOPYRIGHT_SHORT \"\"\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/codec_headers/expat_config.h "#define BYTEORDER 1234\n#define XML_NS 1\n#define XML_DTD 1\n\
#define XML_CONTEXT_BYTES 1024\n#define XML_POOR_ENTROPY 1\n")
add_library(zoneplate_codecs STATIC EXCLUDE_FROM_ALL ${codec_sources})
set_target_properties(zoneplate_codecs PROPERTIES UNITY_BUILD OFF)
target_compile_options(zoneplate_codecs PRIVATE -w -O2)
target_include_directories(zoneplate_codecs SYSTEM PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/codec_headers ${sources_folder}/zlib ${sources_folder}/zlib/contrib
                           ${sources_folder}/libpng1.6 ${sources_folder}/libjpeg-turbo ${sources_folder}/libwebp/src ${sources_folder}/expat/expat/lib
                           ${sources_folder}/meshoptimizer/src)
target_include_directories(zoneplate_codecs PRIVATE ${sources_folder}/libwebp)
# libpng and libjpeg leave their functions by longjmp after an error.
target_compile_options(zoneplate_codecs PUBLIC -sSUPPORT_LONGJMP=wasm)
target_link_options(zoneplate_codecs PUBLIC -sSUPPORT_LONGJMP=wasm)
