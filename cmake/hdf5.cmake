# SPDX-License-Identifier: Apache-2.0
# The target HDF5::HDF5: the plain C library, in the names Debian gives its serial build, else in its own.
# CMake's FindHDF5 asks a C compiler and links what libhdf5 itself depends on, whether it is installed or not.
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial)
find_library(HDF5_LIBRARY NAMES hdf5_serial hdf5)
if(NOT HDF5_INCLUDE_DIR OR NOT HDF5_LIBRARY)
  message(FATAL_ERROR "HDF5 is missing: install libhdf5-dev (./dev deps does)")
endif()
# Debian's shared library reads files from the network too: curl, Kerberos, LDAP and twenty more, whose loading is
# half of the 10 ms that each start of the program takes. Its archive is linked without them.
find_library(HDF5_ARCHIVE NAMES libhdf5_serial.a libhdf5.a)
set(HDF5_ARCHIVE_LIBRARIES ${HDF5_ARCHIVE} sz z ${CMAKE_DL_LIBS} m)
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_INCLUDES ${HDF5_INCLUDE_DIR})
set(CMAKE_REQUIRED_LIBRARIES ${HDF5_ARCHIVE_LIBRARIES})
check_cxx_source_compiles("#include <hdf5.h>\nint main() { return H5open(); }" HDF5_ARCHIVE_LINKS)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)

add_library(HDF5::HDF5 INTERFACE IMPORTED)
target_include_directories(HDF5::HDF5 INTERFACE ${HDF5_INCLUDE_DIR})
if(HDF5_ARCHIVE AND HDF5_ARCHIVE_LINKS)
  # The archive is not made for shared libraries: the Python module takes the shared one.
  set(is_module $<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>)
  target_link_libraries(HDF5::HDF5 INTERFACE $<${is_module}:${HDF5_LIBRARY}>)
  foreach(library ${HDF5_ARCHIVE_LIBRARIES})
    target_link_libraries(HDF5::HDF5 INTERFACE $<$<NOT:${is_module}>:${library}>)
  endforeach()
else()
  target_link_libraries(HDF5::HDF5 INTERFACE ${HDF5_LIBRARY})
endif()
