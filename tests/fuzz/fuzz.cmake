# The importer against arbitrary bytes: the corpus replayed by every build, and the libFuzzer target where the compiler is clang (preset fuzz).
set(here ${CMAKE_CURRENT_LIST_DIR})
add_library(fuzz_base STATIC ${here}/import_check.cpp ${here}/mutate.cpp)
target_link_libraries(fuzz_base PUBLIC tessera_scene nlohmann_json::nlohmann_json)
add_executable(fuzz_corpus_test ${here}/corpus_test.cpp)
target_link_libraries(fuzz_corpus_test PRIVATE fuzz_base GTest::gtest_main)
target_compile_definitions(fuzz_corpus_test PRIVATE TESSERA_FUZZ_CORPUS="${here}/corpus")
gtest_discover_tests(fuzz_corpus_test PROPERTIES LABELS cpu)

# Writes the seeds: `make_corpus FOLDER`.
add_executable(make_corpus EXCLUDE_FROM_ALL ${here}/make_corpus.cpp ${here}/../cpu/gltf_file.cpp)
target_link_libraries(make_corpus PRIVATE tessera_output nlohmann_json::nlohmann_json GTest::gtest)
target_compile_definitions(make_corpus PRIVATE TESSERA_TEST_DATA="${here}/../data")

if(TESSERA_FUZZ)
  add_executable(import_fuzzer ${here}/import_fuzzer.cpp)
  target_link_libraries(import_fuzzer PRIVATE fuzz_base)
  target_link_options(import_fuzzer PRIVATE -fsanitize=fuzzer)
endif()
