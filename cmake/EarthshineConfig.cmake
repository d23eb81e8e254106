# SPDX-License-Identifier: Apache-2.0
# find_package(Earthshine), then link earthshine::studies or a floor below it: earthshine::raytrace, earthshine::degrade ...;
# and earthshine::alone where base/ranks/start.h is called.
include(CMakeFindDependencyMacro)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
foreach(package embree Eigen3 OpenEXR glm TBB tomlplusplus TinyGLTF nlohmann_json PNG JPEG fmt)
  find_dependency(${package})
endforeach()
include(${CMAKE_CURRENT_LIST_DIR}/hdf5.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/EarthshineTargets.cmake)
