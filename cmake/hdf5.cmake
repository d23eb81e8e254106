# SPDX-License-Identifier: Apache-2.0
# The target HDF5::HDF5: the plain C library, in the names Debian gives its serial build, else in its own.
# CMake's FindHDF5 asks a C compiler and links what libhdf5 itself depends on, whether it is installed or not.
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
find_library(HDF5_LIBRARY NAMES hdf5_serial hdf5)
if(NOT HDF5_INCLUDE_DIR OR NOT HDF5_LIBRARY)
  message(FATAL_ERROR "HDF5 is missing: install libhdf5-dev (./dev deps does)")
endif()
add_library(HDF5::HDF5 INTERFACE IMPORTED)
target_include_directories(HDF5::HDF5 INTERFACE ${HDF5_INCLUDE_DIR})
target_link_libraries(HDF5::HDF5 INTERFACE ${HDF5_LIBRARY})
