"""Build files for C and C++ projects that use kernels: CMake targets chosen by name, and files of pkg-config.

Each kernel is also a self-contained file that can be compiled alone: ``cc -c KERNEL.c``.
"""

from symrot import __version__

__all__ = ["FLAGS", "build_files"]

FLAGS = ("-O3", "-fno-math-errno", "-fno-tree-slp-vectorize", "-ffp-contract=off")
"""Recommended flags: loops over samples are vectorised, operations are not fused, square roots do not set errno."""

_CONFIG = """\
# The kernels of this folder for CMake, each a static library of its own. Printed by symrot; do not edit.
#
#     find_package(symrot REQUIRED COMPONENTS euler_zyx_dcm heavy_top PATHS path/to/this/folder)
#     target_link_libraries(firmware PRIVATE symrot::euler_zyx_dcm symrot::heavy_top)
#
# Only kernels that are linked are compiled, with the project's compiler and flags, and with those below. A component is
# the name of a C file in this folder, in its folder scenes, or in a folder of the list SYMROT_FOLDERS. symrot::kernels
# is all components together; without components, all kernels of this folder.
# -DSYMROT_NATIVE=ON compiles for the processor at hand.
if(CMAKE_VERSION VERSION_LESS 3.13)
  set(symrot_FOUND FALSE)
  set(symrot_NOT_FOUND_MESSAGE "symrot needs CMake 3.13 or later, got ${CMAKE_VERSION}")
  return()
endif()
if(NOT CMAKE_C_COMPILER_LOADED)
  enable_language(C)
endif()
option(SYMROT_NATIVE "compile the kernels of symrot for the processor of this machine" OFF)

set(_symrot_folders ${SYMROT_FOLDERS} "${CMAKE_CURRENT_LIST_DIR}" "${CMAKE_CURRENT_LIST_DIR}/scenes")
set(_symrot_kernels ${symrot_FIND_COMPONENTS})
if(NOT _symrot_kernels)
  file(GLOB _symrot_files RELATIVE "${CMAKE_CURRENT_LIST_DIR}" CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/*.c")
  foreach(_symrot_file IN LISTS _symrot_files)
    if(NOT _symrot_file MATCHES "_test[.]c$")
      string(REGEX REPLACE "[.]c$" "" _symrot_kernel "${_symrot_file}")
      list(APPEND _symrot_kernels "${_symrot_kernel}")
    endif()
  endforeach()
endif()
list(REMOVE_DUPLICATES _symrot_kernels)

foreach(_symrot_kernel IN LISTS _symrot_kernels)
  set(symrot_${_symrot_kernel}_FOUND TRUE)
  if(TARGET symrot::${_symrot_kernel})
    continue()
  endif()
  set(_symrot_folder "")
  foreach(_symrot_place IN LISTS _symrot_folders)
    if(NOT _symrot_folder AND EXISTS "${_symrot_place}/${_symrot_kernel}.c")
      get_filename_component(_symrot_folder "${_symrot_place}" ABSOLUTE)
    endif()
  endforeach()
  if(NOT _symrot_folder)
    set(symrot_${_symrot_kernel}_FOUND FALSE)
    if(symrot_FIND_REQUIRED_${_symrot_kernel})
      set(symrot_FOUND FALSE)
      set(symrot_NOT_FOUND_MESSAGE
          "expected a kernel with a file ${_symrot_kernel}.c in ${_symrot_folders}; `symrot emit --list` lists kernels")
    endif()
    continue()
  endif()
  add_library(symrot_${_symrot_kernel} STATIC EXCLUDE_FROM_ALL "${_symrot_folder}/${_symrot_kernel}.c")
  add_library(symrot::${_symrot_kernel} ALIAS symrot_${_symrot_kernel})
  set_target_properties(symrot_${_symrot_kernel} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON
                        POSITION_INDEPENDENT_CODE ON)
  target_include_directories(symrot_${_symrot_kernel} PUBLIC "${_symrot_folder}")
  if(CMAKE_C_COMPILER_ID MATCHES "GNU")
    target_compile_options(symrot_${_symrot_kernel} PRIVATE @GNU@)
  elseif(CMAKE_C_COMPILER_ID MATCHES "Clang")
    target_compile_options(symrot_${_symrot_kernel} PRIVATE @CLANG@)
  endif()
  if(SYMROT_NATIVE)
    target_compile_options(symrot_${_symrot_kernel} PRIVATE -march=native)
  endif()
  if(UNIX)
    target_link_libraries(symrot_${_symrot_kernel} PUBLIC m)
  endif()
endforeach()

if(NOT TARGET symrot_kernels)
  add_library(symrot_kernels INTERFACE)
  add_library(symrot::kernels ALIAS symrot_kernels)
endif()
foreach(_symrot_kernel IN LISTS _symrot_kernels)
  if(TARGET symrot_${_symrot_kernel})
    target_link_libraries(symrot_kernels INTERFACE symrot_${_symrot_kernel})
  endif()
endforeach()
"""

_VERSION = """\
# The version of symrot that printed the kernels of this folder. Printed by symrot; do not edit.
set(PACKAGE_VERSION "@VERSION@")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
elseif(PACKAGE_FIND_VERSION_MAJOR STREQUAL "@MAJOR@" AND PACKAGE_FIND_VERSION_MINOR STREQUAL "@MINOR@")
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
"""

_CMAKE = """\
# Kernels of symrot as static libraries, and their installation. Printed by symrot; do not edit.
#
#     add_subdirectory(path/to/this/folder symrot)
#     target_link_libraries(firmware PRIVATE symrot::heavy_top)
#
# Inside another project, only kernels that are linked are compiled. On its own, the folder builds and installs all its
# kernels, or those that -DSYMROT_KERNELS="euler_zyx_dcm;heavy_top" names. Several folders may have one prefix.
# After the installation, find_package(symrot COMPONENTS ..) and `pkg-config --libs symrot-heavy_top` know them by name.
cmake_minimum_required(VERSION 3.13)
project(symrot_kernels VERSION @VERSION@ LANGUAGES C)

set(SYMROT_KERNELS "" CACHE STRING "names of the kernels to build and to install; empty: all")
find_package(symrot REQUIRED COMPONENTS ${SYMROT_KERNELS} PATHS "${CMAKE_CURRENT_SOURCE_DIR}" NO_DEFAULT_PATH)

if(NOT CMAKE_CURRENT_SOURCE_DIR STREQUAL CMAKE_SOURCE_DIR)
  return()
endif()

foreach(kernel IN LISTS _symrot_kernels)
  get_target_property(source symrot_${kernel} SOURCES)
  get_filename_component(folder "${source}" DIRECTORY)
  list(APPEND symrot_sources "${source}" "${folder}/${kernel}.h")
  if(EXISTS "${folder}/${kernel}_parameters.h")
    list(APPEND symrot_sources "${folder}/${kernel}_parameters.h")
  endif()
  set_target_properties(symrot_${kernel} PROPERTIES EXCLUDE_FROM_ALL FALSE)
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/symrot-${kernel}.pc" "prefix=${CMAKE_INSTALL_PREFIX}

Name: symrot-${kernel}
Description: The kernel ${kernel} of symrot
Version: @VERSION@
Cflags: -I\\${prefix}/share/symrot
Libs: -L\\${prefix}/lib -lsymrot_${kernel} -lm
")
  install(TARGETS symrot_${kernel} ARCHIVE DESTINATION lib)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/symrot-${kernel}.pc" DESTINATION lib/pkgconfig)
endforeach()
if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/symrot_math.h")
  list(APPEND symrot_sources "${CMAKE_CURRENT_SOURCE_DIR}/symrot_math.h")
endif()
install(FILES ${symrot_sources} symrotConfig.cmake symrotConfigVersion.cmake DESTINATION share/symrot)
"""


def build_files() -> dict[str, str]:
    """Return the texts of the build files for a folder with all C kernels: a mapping from file name to text."""
    clang = " ".join(flag for flag in FLAGS if "tree" not in flag)
    major, minor, *_ = __version__.split(".")
    texts = {"CMakeLists.txt": _CMAKE, "symrotConfig.cmake": _CONFIG, "symrotConfigVersion.cmake": _VERSION}
    values = {"GNU": " ".join(FLAGS), "CLANG": clang, "VERSION": __version__, "MAJOR": major, "MINOR": minor}
    for word, value in values.items():
        texts = {name: text.replace(f"@{word}@", value) for name, text in texts.items()}
    return texts
