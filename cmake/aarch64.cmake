# How Ballpark is built here for Linux on 64-bit ARM, with Debian's cross compiler:
#
#   tests/aarch64/make_root build/aarch64-root
#   cmake -B build/aarch64 -G Ninja --toolchain cmake/aarch64.cmake -DAARCH64_ROOT=$PWD/build/aarch64-root
#
# In:   AARCH64_ROOT, a folder with that machine's libraries and headers.
# Out:  the compiler, and where CMake and pkg-config look; with qemu-user, how what is built can run.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(AARCH64_ROOT "" CACHE PATH "the root of a system for 64-bit ARM, absolute")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES AARCH64_ROOT)
set(CMAKE_SYSROOT ${AARCH64_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # programs that run during the build are this machine's
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} ${AARCH64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${AARCH64_ROOT}/usr/share/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${AARCH64_ROOT})

# The build runs write_documents.
find_program(AARCH64_QEMU NAMES qemu-aarch64-static qemu-aarch64)
if(AARCH64_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${AARCH64_QEMU} -L ${AARCH64_ROOT})
endif()
