# Tests that wait for threads of the lowest priority, which trace the window's reference: beside another test they would
# wait for it, too.
foreach(test "a ground is a shadow on the background in the reference, too"
             "the reference is beside the view, alone and as a difference, and follows the view")
  set_tests_properties("viewer:viewer: ${test}" PROPERTIES RUN_SERIAL TRUE)
endforeach()
