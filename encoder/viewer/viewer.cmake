# SPDX-License-Identifier: MIT
# Sets viewer_page to a source that holds the page of render -o FILE.html: the decoder as WebAssembly, and what draws.
# Without the tools for that, to one that says which are missing.
set(missing "")
foreach(tool clang++ wasm-ld llvm-ar wasm-opt zopfli esbuild)
  find_program(MICROTIN_TOOL_${tool} ${tool})
  if(NOT MICROTIN_TOOL_${tool})
    list(APPEND missing ${tool})
  endif()
endforeach()
list(JOIN missing ", " missing)
set(viewer_page ${CMAKE_CURRENT_BINARY_DIR}/viewer_page.cpp)
if(missing)
  configure_file(viewer/absent.cpp.in ${viewer_page} @ONLY)
  return()
endif()

find_package(Python3 REQUIRED COMPONENTS Interpreter)
file(GLOB viewer_parts CONFIGURE_DEPENDS viewer/*.js viewer/*.html viewer/*.css viewer/*.py
  ${PROJECT_SOURCE_DIR}/decoder/*.?pp ${PROJECT_SOURCE_DIR}/shared/*.hpp
  ${PROJECT_SOURCE_DIR}/decoder/include/microtin/*.h
  ${PROJECT_SOURCE_DIR}/decoder/packages/npm/* ${PROJECT_SOURCE_DIR}/decoder/packages/npm/src/*.js)
set(viewer_wasm ${CMAKE_CURRENT_BINARY_DIR}/viewer)
add_custom_command(OUTPUT ${viewer_page}
  COMMAND ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} -B ${viewer_wasm} -G Ninja
          --toolchain ${PROJECT_SOURCE_DIR}/toolchains/wasm32.cmake
          -DCMAKE_BUILD_TYPE=MinSizeRel -DMICROTIN_TESTS=OFF -DMICROTIN_INSTALL=OFF
  COMMAND ${CMAKE_COMMAND} --build ${viewer_wasm} --target npm
  COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/viewer/build.py
          ${viewer_wasm}/npm/microtin.js ${viewer_page}
  DEPENDS ${viewer_parts}
  COMMENT "The page that shows a terrain")
