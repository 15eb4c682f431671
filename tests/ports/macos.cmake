# SPDX-License-Identifier: MIT
# A toolchain for macos.py: clang and lld for macOS, without Apple's headers and libraries. So it configures everything,
# and compiles and links what needs no system: the decoder.
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET arm64-apple-macos11)
set(CMAKE_CXX_FLAGS_INIT "-ffreestanding -stdlib=libc++")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
find_program(MICROTIN_CLANG clang++ REQUIRED)
file(REAL_PATH ${MICROTIN_CLANG} clang)
cmake_path(GET clang PARENT_PATH tools)
set(CMAKE_AR ${tools}/llvm-ar)
set(CMAKE_RANLIB ${tools}/llvm-ranlib)
set(CMAKE_INSTALL_NAME_TOOL ${tools}/llvm-install-name-tool)

# What the system has. The headers are those of this host: nothing that needs them is compiled.
set(CMAKE_HAVE_LIBC_PTHREAD TRUE)
set(ZLIB_INCLUDE_DIR /usr/include)
set(ZLIB_LIBRARY /usr/lib/libz.tbd)
