# Upstream's functions. Its linters (a copy of cpplint, pep8 of Python 2's time) are not in Debian,
# so they only say that nothing is checked; `make roslint_PROJECT` exists and says the same.
function(_roslint_target)
  if(NOT TARGET roslint_${PROJECT_NAME})
    add_custom_target(roslint_${PROJECT_NAME}
      COMMAND ${CMAKE_COMMAND} -E echo "roslint: the style of ${PROJECT_NAME} is not checked here")
  endif()
endfunction()
function(roslint_custom)
  _roslint_target()
endfunction()
function(roslint_cpp)
  _roslint_target()
endfunction()
function(roslint_python)
  _roslint_target()
endfunction()
function(roslint_add_test)
endfunction()
