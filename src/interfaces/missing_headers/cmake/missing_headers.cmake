# What Debian's headers and ours lack for C++ that builds on ROS Noetic, mended without a change in
# the learner's files. Included by CMake after each package's project(), as catkin_make and the
# other build tools here ask it to (workspace_needs/places.py); and for a plain cmake by
# find_package(gazebo) and each package here whose upstream has C++ headers that are not here. At
# the end of the CMakeLists.txt:
# - a target that includes a header that is not here is built without its sources, with one line: a
#   workspace with one Gazebo plugin must still build its other packages. A header that is found
#   (Debian's, or the workspace's own copy) leaves nothing out;
# - a header of a package that the CMakeLists.txt does not name is found, with one line: upstream
#   has one folder of headers for all packages;
# - a target that includes PCL's visualisation gets VTK's headers, which Debian's pcl_ros, unlike
#   upstream's, does not export;
# - sources with _1 of boost::bind get boost's placeholders, which roscpp's headers bring in
#   upstream and Debian's do not.

# A learner's cmake_minimum_required may be of 2010; the lines below must not depend on it.
cmake_policy(PUSH)
cmake_policy(VERSION 3.19)

# Where Debian's headers are.
if(NOT DEFINED MISSING_HEADERS_SYSTEM)
  set(MISSING_HEADERS_SYSTEM /usr/include /usr/local/include)
endif()

# The first folder of the missing headers, and whose they are.
set(_missing_headers_gazebo gazebo gazebo_plugins gazebo_ros_control ignition sdf)
set(_missing_headers_ros_control
  ackermann_steering_controller combined_robot_hw control_toolbox controller_interface
  controller_manager diff_drive_controller effort_controllers force_torque_sensor_controller
  forward_command_controller four_wheel_steering_controller gripper_action_controller
  hardware_interface imu_sensor_controller joint_limits_interface joint_state_controller
  joint_trajectory_controller position_controllers realtime_tools transmission_interface
  velocity_controllers)
set(_missing_headers_navigation
  amcl base_local_planner carrot_planner clear_costmap_recovery costmap_2d dwa_local_planner
  global_planner gmapping map_server move_base move_slow_and_clear nav_core navfn rotate_recovery
  voxel_grid)

# Sets `out` to the reason why a header that was not found is missing, or to nothing.
function(_missing_headers_reason header out)
  string(REGEX REPLACE "/.*" "" folder "${header}")
  set(reason "")
  if(header MATCHES "/")
    if(folder IN_LIST _missing_headers_gazebo)
      set(reason "the C++ API of Gazebo")
    elseif(folder IN_LIST _missing_headers_ros_control)
      set(reason "the C++ API of ros_control")
    elseif(folder IN_LIST _missing_headers_navigation)
      set(reason "the C++ API of navigation")
    endif()
  endif()
  set(${out} "${reason}" PARENT_SCOPE)
endfunction()

# Sets `out` to the file that an include directive of `file` leads to, or to nothing.
function(_missing_headers_find header file folders out)
  get_filename_component(own "${file}" DIRECTORY)
  set(${out} "" PARENT_SCOPE)
  foreach(folder IN LISTS own folders MISSING_HEADERS_SYSTEM)
    if(EXISTS "${folder}/${header}")
      set(${out} "${folder}/${header}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Sets `out` to whether the compiler's preprocessor goes through all sources of the target: the
# include directive of a missing header may lie in a comment or behind a condition that is not met.
# It sees no folders and definitions of libraries that are linked to; FALSE is no proof.
function(_missing_headers_preprocess sources folders definitions out)
  set(${out} FALSE PARENT_SCOPE)
  if(NOT CMAKE_CXX_COMPILER)
    return()
  endif()
  separate_arguments(words UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
  list(TRANSFORM folders PREPEND -I)
  list(TRANSFORM definitions PREPEND -D)
  list(APPEND words ${folders} ${definitions})
  list(FILTER words EXCLUDE REGEX "\\$<")
  foreach(source IN LISTS sources)
    if(source MATCHES "\\.(c|cc|cpp|cxx|C)$")
      execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${words} -E -o /dev/null "${source}"
        RESULT_VARIABLE code OUTPUT_QUIET ERROR_QUIET)
      if(NOT code EQUAL 0)
        return()
      endif()
    endif()
  endforeach()
  set(${out} TRUE PARENT_SCOPE)
endfunction()

# Walks through the target's sources and the headers of the workspace that they lead to. Sets
# `out_files` to these, `out_headers` to all that they include, and `out_absent` to "FILE|HEADER"
# for each of these that was not found.
function(_missing_headers_walk sources folders out_files out_absent out_headers)
  set(waiting "${sources}")
  set(seen "")
  set(absent "")
  set(headers "")
  while(waiting)
    list(POP_FRONT waiting file)
    if(file IN_LIST seen OR NOT EXISTS "${file}" OR IS_DIRECTORY "${file}")
      continue()
    endif()
    list(APPEND seen "${file}")
    file(STRINGS "${file}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"][^>\"]+[>\"]")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]+)[>\"].*" "\\1" header "${line}")
      list(APPEND headers "${header}")
      _missing_headers_find("${header}" "${file}" "${folders}" found)
      if(NOT found)
        list(APPEND absent "${file}|${header}")
      elseif(NOT found MATCHES "^/usr/")
        list(APPEND waiting "${found}")
      endif()
    endforeach()
  endwhile()
  set(${out_files} "${seen}" PARENT_SCOPE)
  set(${out_absent} "${absent}" PARENT_SCOPE)
  set(${out_headers} "${headers}" PARENT_SCOPE)
endfunction()

# Adds VTK's folder and PCL's library to a target that includes PCL's visualisation or VTK.
function(_missing_headers_vtk target headers)
  if(NOT headers MATCHES "(^|;)(pcl/visualization/|vtk[A-Z])")
    return()
  endif()
  list(TRANSFORM MISSING_HEADERS_SYSTEM APPEND "/vtk-*" OUTPUT_VARIABLE patterns)
  file(GLOB folders ${patterns})
  set_property(TARGET ${target} APPEND PROPERTY INCLUDE_DIRECTORIES ${folders})
  file(GLOB library "/usr/lib/*/libpcl_visualization.so")
  if(library)
    set_property(TARGET ${target} APPEND PROPERTY LINK_LIBRARIES ${library})
  endif()
endfunction()

# Adds the folder of a header that another sourced workspace has to the target; sets `out` to
# whether there is one.
function(_missing_headers_undeclared target header out)
  set(${out} FALSE PARENT_SCOPE)
  string(REGEX REPLACE "/.*" "" package "${header}")
  foreach(prefix IN LISTS CMAKE_PREFIX_PATH)
    if(header MATCHES "/" AND EXISTS "${prefix}/include/${header}")
      set_property(TARGET ${target} APPEND PROPERTY INCLUDE_DIRECTORIES "${prefix}/include")
      get_property(told DIRECTORY PROPERTY MISSING_HEADERS_TOLD)
      if(NOT package IN_LIST told)
        set_property(DIRECTORY APPEND PROPERTY MISSING_HEADERS_TOLD ${package})
        message(NOTICE "${PROJECT_NAME}: <${header}> is included, but CMakeLists.txt does not \
name ${package} in find_package(catkin ... COMPONENTS ...): found all the same")
      endif()
      set(${out} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Gives the sources of a target that use _1 without naming a placeholder's namespace those of boost.
function(_missing_headers_placeholders target sources files)
  set(use "(^|[^A-Za-z0-9_:.>])_[1-9]([^A-Za-z0-9_]|$)")
  set(in_header FALSE)
  set(wanting "")
  foreach(file IN LISTS files)
    file(STRINGS "${file}" named REGEX "placeholders|boost/(lambda|phoenix|spirit)")
    file(STRINGS "${file}" used REGEX "${use}")
    file(STRINGS "${file}" bound REGEX "bind *[(<]")
    list(FILTER named EXCLUDE REGEX "^[ \t]*(//|/?\\*)")  # comments
    if(named AND NOT file IN_LIST sources)
      return()
    elseif(used AND bound AND NOT named)
      if(file IN_LIST sources)
        list(APPEND wanting "${file}")
      else()
        set(in_header TRUE)
      endif()
    elseif(named)
      list(APPEND naming "${file}")
    endif()
  endforeach()
  if(in_header)
    set(wanting "${sources}")
    list(REMOVE_ITEM wanting ${naming} "")
  endif()
  list(FILTER wanting INCLUDE REGEX "\\.(cc|cpp|cxx|C)$")
  foreach(source IN LISTS wanting)
    set_property(SOURCE "${source}" TARGET_DIRECTORY ${target} APPEND_STRING PROPERTY
      COMPILE_FLAGS " -include boost/bind.hpp")
    set_property(SOURCE "${source}" TARGET_DIRECTORY ${target} APPEND PROPERTY
      COMPILE_DEFINITIONS BOOST_BIND_GLOBAL_PLACEHOLDERS)
  endforeach()
endfunction()

# Sets `out` to "FILE includes <HEADER>, and WHAT is not here" for the first missing header that
# the target's sources, and headers of the workspace, lead to; to nothing if there is none, and
# mends the target.
function(_missing_headers_of target out)
  set(${out} "" PARENT_SCOPE)
  get_target_property(base ${target} SOURCE_DIR)
  get_target_property(listed ${target} SOURCES)
  get_target_property(folders ${target} INCLUDE_DIRECTORIES)
  string(REGEX REPLACE "\\$<BUILD_INTERFACE:([^>]*)>" "\\1" folders "${folders}")
  set(sources "")
  foreach(source IN LISTS listed)
    get_filename_component(source "${source}" ABSOLUTE BASE_DIR "${base}")
    list(APPEND sources "${source}")
  endforeach()
  _missing_headers_walk("${sources}" "${folders}" files absent headers)
  foreach(pair IN LISTS absent)
    string(REGEX REPLACE "^(.*)\\|" "" header "${pair}")
    string(REGEX REPLACE "\\|[^|]*$" "" file "${pair}")
    _missing_headers_undeclared(${target} "${header}" found)
    _missing_headers_reason("${header}" reason)
    if(reason AND NOT found)
      get_target_property(definitions ${target} COMPILE_DEFINITIONS)
      string(REGEX REPLACE "-NOTFOUND$" "" definitions "${definitions}")
      _missing_headers_preprocess("${sources}" "${folders}" "${definitions}" harmless)
      if(NOT harmless)
        file(RELATIVE_PATH shown "${PROJECT_SOURCE_DIR}" "${file}")
        set(${out} "${shown} includes <${header}>, and ${reason} is not here" PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
  _missing_headers_vtk(${target} "${headers}")
  _missing_headers_placeholders(${target} "${sources}" "${files}")
endfunction()

# The target keeps its name, so that install() and dependencies on it stay valid: a library
# becomes an empty one, a program one that says why it is not there.
function(_missing_headers_leave_out target reason)
  message(NOTICE "${PROJECT_NAME}: target ${target} is left out: ${reason}. \
What the simulator has in its place: rosrun bullet_sim_ros check ${PROJECT_NAME}")
  set(stub "${CMAKE_CURRENT_BINARY_DIR}/missing_headers/${target}.cpp")
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")
    set(text "#include <cstdio>
int main() {
  std::fputs(R\"line(${target} was left out when ${PROJECT_NAME} was built: ${reason}.
)line\", stderr);
  return 1;
}
")
  else()
    set(text "// ${target} is left out: ${reason}.\n")
  endif()
  file(CONFIGURE OUTPUT "${stub}" CONTENT "${text}" @ONLY)
  set_target_properties(${target} PROPERTIES
    SOURCES "${stub}" LINK_LIBRARIES "" LINKER_LANGUAGE CXX COMPILE_OPTIONS "" COMPILE_FLAGS ""
    LEFT_OUT_FOR_MISSING_HEADERS TRUE)
endfunction()

# Sets `out` to the targets of a folder and of the folders below it that compile something.
function(_missing_headers_targets folder out)
  get_property(found DIRECTORY "${folder}" PROPERTY BUILDSYSTEM_TARGETS)
  set(all "")
  foreach(target IN LISTS found)
    get_target_property(type ${target} TYPE)
    if(type MATCHES "^(EXECUTABLE|(SHARED|STATIC|MODULE|OBJECT)_LIBRARY)$")
      list(APPEND all ${target})
    endif()
  endforeach()
  get_property(below DIRECTORY "${folder}" PROPERTY SUBDIRECTORIES)
  foreach(child IN LISTS below)
    _missing_headers_targets("${child}" more)
    list(APPEND all ${more})
  endforeach()
  set(${out} "${all}" PARENT_SCOPE)
endfunction()

# Sets `out` to the reason why a target that links to others cannot be there, or to nothing.
function(_missing_headers_linked target out)
  set(${out} "" PARENT_SCOPE)
  get_target_property(linked ${target} LINK_LIBRARIES)
  foreach(library IN LISTS linked)
    if(TARGET "${library}")
      get_target_property(left_out "${library}" LEFT_OUT_FOR_MISSING_HEADERS)
      if(left_out)
        set(${out} "it links to ${library}, which is left out" PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
endfunction()

function(_missing_headers_examine)
  _missing_headers_targets("${CMAKE_CURRENT_SOURCE_DIR}" waiting)
  foreach(target IN LISTS waiting)
    _missing_headers_of(${target} reason)
    if(reason)
      _missing_headers_leave_out(${target} "${reason}")
    endif()
  endforeach()
  set(again TRUE)
  while(again)
    set(again FALSE)
    foreach(target IN LISTS waiting)
      _missing_headers_linked(${target} reason)
      if(reason)
        _missing_headers_leave_out(${target} "${reason}")
        set(again TRUE)
      endif()
    endforeach()
  endwhile()
endfunction()

get_property(_missing_headers_asked DIRECTORY PROPERTY MISSING_HEADERS_ASKED)
if(NOT _missing_headers_asked AND NOT PROJECT_NAME STREQUAL "Project")  # catkin's toplevel.cmake
  set_property(DIRECTORY PROPERTY MISSING_HEADERS_ASKED TRUE)
  cmake_language(DEFER CALL _missing_headers_examine)
endif()
cmake_policy(POP)
