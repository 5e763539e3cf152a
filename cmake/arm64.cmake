# Cross-compiles for arm64 with Debian's g++-aarch64-linux-gnu and runs what it built under qemu-user. The libraries come
# from a folder of their own, which scripts/lib/arm64_root.sh fills, so that nothing is installed into this machine.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

cmake_path(ABSOLUTE_PATH CMAKE_CURRENT_LIST_DIR NORMALIZE OUTPUT_VARIABLE mssim_here)
cmake_path(GET mssim_here PARENT_PATH mssim_source)
set(mssim_root ${mssim_source}/build/arm64-root)
if(NOT EXISTS ${mssim_root}/usr/lib/aarch64-linux-gnu)
  message(FATAL_ERROR "there are no libraries for arm64 in ${mssim_root}; scripts/test --arm64 puts them there")
endif()

set(CMAKE_SYSROOT ${mssim_root})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${mssim_root})
set(ENV{PKG_CONFIG_LIBDIR} ${mssim_root}/usr/lib/aarch64-linux-gnu/pkgconfig:${mssim_root}/usr/share/pkgconfig)

set(CMAKE_CROSSCOMPILING_EMULATOR ${mssim_source}/scripts/lib/run_arm64)
