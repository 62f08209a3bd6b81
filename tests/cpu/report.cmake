# Error metrics against closed forms, and what a report says of measurements.
set(here ${CMAKE_CURRENT_LIST_DIR})
add_executable(report_test ${here}/build_test_scenes.cpp ${here}/reference_test_scenes.cpp ${here}/metric_fronts_test.cpp ${here}/original_error_test.cpp ${here}/report_files_test.cpp ${here}/report_metrics_test.cpp)
target_link_libraries(report_test PRIVATE tessera_report GTest::gtest_main)
gtest_discover_tests(report_test PROPERTIES LABELS cpu)
