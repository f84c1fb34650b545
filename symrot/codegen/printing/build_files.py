"""Build files for C and C++ projects that use the library of kernels: a CMake target and a pkg-config file.

Each kernel is also a self-contained file that can be compiled alone: ``cc -c KERNEL.c``.
"""

__all__ = ["FLAGS", "build_files"]

FLAGS = ("-O3", "-fno-math-errno", "-fno-tree-slp-vectorize", "-ffp-contract=off")
"""Recommended flags: loops over samples are vectorised, operations are not fused, square roots do not set errno."""

_CMAKE = """\
# Kernels of symrot as a static library. Printed by `symrot emit --all`; do not edit.
#
#     add_subdirectory(path/to/generated/c symrot)
#     target_link_libraries(firmware PRIVATE symrot::kernels)
#
# Only the kernels that a program calls are linked. -DSYMROT_NATIVE=ON compiles for the processor at hand.
cmake_minimum_required(VERSION 3.13)
project(symrot_kernels LANGUAGES C)

option(SYMROT_NATIVE "compile kernels for the processor of this machine" OFF)

file(GLOB SYMROT_KERNELS CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.c")
add_library(symrot_kernels STATIC ${SYMROT_KERNELS})
add_library(symrot::kernels ALIAS symrot_kernels)
set_target_properties(symrot_kernels PROPERTIES OUTPUT_NAME symrot C_STANDARD 99 C_STANDARD_REQUIRED ON
                      POSITION_INDEPENDENT_CODE ON)
target_include_directories(symrot_kernels PUBLIC "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>"
                           "$<INSTALL_INTERFACE:include/symrot>")
if(CMAKE_C_COMPILER_ID MATCHES "GNU")
  target_compile_options(symrot_kernels PRIVATE @GNU@)
elseif(CMAKE_C_COMPILER_ID MATCHES "Clang")
  target_compile_options(symrot_kernels PRIVATE @CLANG@)
endif()
if(SYMROT_NATIVE)
  target_compile_options(symrot_kernels PRIVATE -march=native)
endif()
if(UNIX)
  target_link_libraries(symrot_kernels PUBLIC m)
endif()

set(prefix "${CMAKE_INSTALL_PREFIX}")
configure_file(symrot.pc.in symrot.pc @ONLY)
file(GLOB SYMROT_HEADERS CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.h")
install(TARGETS symrot_kernels ARCHIVE DESTINATION lib)
install(FILES ${SYMROT_HEADERS} DESTINATION include/symrot)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/symrot.pc" DESTINATION lib/pkgconfig)
"""

_PKG_CONFIG = """\
# Printed by `symrot emit --all`; do not edit. CMake puts in the prefix; by hand: sed 's|@prefix@|/usr/local|'
prefix=@prefix@
includedir=${prefix}/include/symrot
libdir=${prefix}/lib

Name: symrot
Description: Kernels of rigid-body rotation, emitted by symrot
Version: 1
Cflags: -I${includedir}
Libs: -L${libdir} -lsymrot -lm
"""


def build_files() -> dict[str, str]:
    """Return the texts of the build files for the folder of C kernels, by file name."""
    clang = " ".join(flag for flag in FLAGS if "tree" not in flag)
    cmake = _CMAKE.replace("@GNU@", " ".join(FLAGS)).replace("@CLANG@", clang)
    return {"CMakeLists.txt": cmake, "symrot.pc.in": _PKG_CONFIG}
