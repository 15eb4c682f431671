# SPDX-License-Identifier: MIT
# Sets viewer_page to a source that holds the page of render -o FILE.html: the decoder as WebAssembly, and what draws.
# The page is built if its tools are there; else taken from generated/, as release archives have it; else left out.
set(MICROTIN_VIEWER AUTO CACHE STRING "The page of render -o FILE.html: ON (required), AUTO (if possible) or OFF")
set_property(CACHE MICROTIN_VIEWER PROPERTY STRINGS ON AUTO OFF)

set(viewer_page ${CMAKE_CURRENT_BINARY_DIR}/viewer_page.cpp)
set(viewer_folder ${CMAKE_CURRENT_LIST_DIR})
set(viewer_generated ${viewer_folder}/generated/viewer_page.cpp)

set(missing "")
foreach(tool clang++ wasm-ld llvm-ar wasm-opt zopfli esbuild python3)
  find_program(MICROTIN_TOOL_${tool} ${tool})
  if(NOT MICROTIN_TOOL_${tool})
    list(APPEND missing ${tool})
  endif()
endforeach()
list(JOIN missing ", " missing)

if(NOT MICROTIN_VIEWER AND NOT MICROTIN_VIEWER STREQUAL AUTO)
  set(viewer_reason "MICROTIN_VIEWER was OFF")
elseif(missing AND EXISTS ${viewer_generated})
  set(viewer_page ${viewer_generated})
  return()
elseif(missing AND NOT MICROTIN_VIEWER STREQUAL AUTO)
  message(FATAL_ERROR "MICROTIN_VIEWER is ${MICROTIN_VIEWER}, but these programs were not found: ${missing}. "
    ".ci/packages/tool lists Debian's packages for them.")
elseif(missing)
  message(NOTICE "Left out: the page of render -o FILE.html. These programs were not found: ${missing}. "
    ".ci/packages/tool lists Debian's packages for them; -DMICROTIN_VIEWER=ON requires the page, OFF omits it.")
  set(viewer_reason "these programs were not found: ${missing}")
endif()
if(DEFINED viewer_reason)
  configure_file(${viewer_folder}/absent.cpp.in ${viewer_page} @ONLY)
  return()
endif()

cmake_path(SET viewer_root NORMALIZE ${viewer_folder}/../..)
file(GLOB viewer_parts CONFIGURE_DEPENDS
  ${viewer_folder}/*.js ${viewer_folder}/*.html ${viewer_folder}/*.css ${viewer_folder}/*.py
  ${viewer_root}/decoder/*.?pp ${viewer_root}/shared/*.hpp ${viewer_root}/decoder/include/microtin/*.h
  ${viewer_root}/decoder/packages/npm/* ${viewer_root}/decoder/packages/npm/src/*.js)
set(viewer_wasm ${CMAKE_CURRENT_BINARY_DIR}/viewer)
# The environment's flags, such as a packager's for hardening, are the host's.
set(viewer_cmake ${CMAKE_COMMAND} -E env
  --unset=CFLAGS --unset=CXXFLAGS --unset=CPPFLAGS --unset=LDFLAGS ${CMAKE_COMMAND})
add_custom_command(OUTPUT ${viewer_page}
  COMMAND ${viewer_cmake} -S ${viewer_root} -B ${viewer_wasm} -G ${CMAKE_GENERATOR}
          -DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM} --toolchain ${viewer_root}/toolchains/wasm32.cmake
          -DCMAKE_BUILD_TYPE=MinSizeRel -DMICROTIN_TESTS=OFF -DMICROTIN_INSTALL=OFF
  COMMAND ${viewer_cmake} --build ${viewer_wasm} --target npm --config MinSizeRel
  COMMAND ${MICROTIN_TOOL_python3} ${viewer_folder}/build.py ${viewer_wasm}/npm/microtin.js ${viewer_page}
  DEPENDS ${viewer_parts} VERBATIM
  COMMENT "The page that shows a terrain")

# Puts the page among the sources, for archives that are built where its tools are not.
add_custom_target(viewer_source
  COMMAND ${CMAKE_COMMAND} -E make_directory ${viewer_folder}/generated
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_page} ${viewer_generated}
  DEPENDS ${viewer_page} VERBATIM)
