# find_package(cv_bridge): Debian's, for C++, if its package libcv-bridge-dev is installed; without
# it nothing but the name, which is all that a package in Python asks for.
file(GLOB _cv_bridge_debian
  /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/cv_bridge/cv_bridgeConfig.cmake
  /usr/lib/*/cmake/cv_bridge/cv_bridgeConfig.cmake)
if(_cv_bridge_debian)
  list(GET _cv_bridge_debian 0 _cv_bridge_debian)
  get_filename_component(cv_bridge_DIR "${_cv_bridge_debian}" DIRECTORY)
  include("${_cv_bridge_debian}")
else()
  message(STATUS "cv_bridge: for Python alone; its C++ headers come with libcv-bridge-dev")
  set(cv_bridge_FOUND TRUE)
  set(cv_bridge_FOUND_CATKIN_PROJECT TRUE)
  set(cv_bridge_INCLUDE_DIRS "")
  set(cv_bridge_LIBRARIES "")
endif()
