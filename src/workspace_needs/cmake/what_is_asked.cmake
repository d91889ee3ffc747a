# A dependency provider for one configuration that is thrown away: a package that is required and
# not found is written to WORKSPACE_NEEDS_ABSENT and counts as found, so that one run names all of
# them. Only what fails without it is configured with it (workspace_needs/configuring.py).
cmake_policy(PUSH)
cmake_policy(VERSION 3.24)  # whatever the package asks for
macro(_workspace_needs_find _wn_method _wn_name)
  set(_wn_words ${ARGN})
  if("${_wn_name}" STREQUAL "catkin" OR NOT "REQUIRED" IN_LIST _wn_words)
    find_package(${_wn_name} ${_wn_words} BYPASS_PROVIDER)
  else()
    list(REMOVE_ITEM _wn_words REQUIRED)
    find_package(${_wn_name} ${_wn_words} QUIET BYPASS_PROVIDER)
    if(NOT ${_wn_name}_FOUND)
      file(APPEND "${WORKSPACE_NEEDS_ABSENT}" "${_wn_name}\n")
      set(${_wn_name}_FOUND TRUE)
    endif()
  endif()
endmacro()
cmake_language(SET_DEPENDENCY_PROVIDER _workspace_needs_find SUPPORTED_METHODS FIND_PACKAGE)
cmake_policy(POP)
