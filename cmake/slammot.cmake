# One folder = one static library = one namespace. Includes are written from the top of the tree:
# #include "common/geometry/pose2.hpp".

include(GoogleTest)

# What nearly every source includes, compiled once: a tenth of the time of a clean build. A source that relies on it for what it
# does not include itself fails in `deploy/tidy --syntax --changed`, which does without. Of GCC's options the first is what ccache
# needs; with the others GCC collects its garbage less often: a tenth of its time for a fifth more memory (up to 1.7 GB a source).
set(SLAMMOT_GCC_OPTIONS
    "$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;--param=ggc-min-expand=1000;--param=ggc-min-heapsize=1000000>")
set(SLAMMOT_LIBRARY_OPTIONS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion ${SLAMMOT_GCC_OPTIONS})

# slammot_precompile(core_headers LINK Eigen3::Eigen OPTIONS -Wall HEADERS <vector> <string>): other targets take these headers by REUSE_FROM.
# ccache would hash a precompiled header, of 140 MB, for each source that uses it: half a second each. It takes the sum beside it
# instead, of what the header is made from.
function(slammot_precompile name)
  cmake_parse_arguments(ARG "" "" "LINK;OPTIONS;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  set_target_properties(${name} PROPERTIES COMPILE_WARNING_AS_ERROR OFF)  # else ccache misses all after a change of SLAMMOT_WERROR
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})

  set(all ${CMAKE_CURRENT_BINARY_DIR}/${name}_all.cpp)
  list(TRANSFORM ARG_HEADERS REPLACE "(.+)" "#include \\1\n" OUTPUT_VARIABLE lines)
  list(JOIN lines "" content)
  file(CONFIGURE OUTPUT ${all} CONTENT "${content}")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${flags} -std=c++20 -isystem ${eigen} -E -P ${all} OUTPUT_FILE ${all}.i COMMAND_ERROR_IS_FATAL ANY)
  file(SHA256 ${all}.i sum)
  file(REMOVE ${all}.i)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/cmake_pch.hxx.gch.sum
       CONTENT "${sum} ${CMAKE_CXX_COMPILER_VERSION} ${flags} ${ARG_OPTIONS}")
endfunction()

slammot_precompile(core_headers LINK Eigen3::Eigen OPTIONS ${SLAMMOT_LIBRARY_OPTIONS} HEADERS
  <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky> <Eigen/LU>
  <algorithm> <array> <chrono> <cmath> <cstdint> <deque> <filesystem> <functional> <map> <memory> <numbers> <numeric>
  <optional> <random> <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector>)

# slammot_library(common_geometry SOURCES a.cpp b.cpp LINK Eigen3::Eigen)
# Releases compile up to 30 sources of a library as one: their common headers (Eigen, CLI11, nlohmann::json, Boost.Beast) cost more
# than they do themselves. So names are unique within a library, also those without linkage: of two functions of a name, a call could
# take the wrong one. Builds with sanitizers do the same; elsewhere each source is compiled by itself.
function(slammot_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE ${SLAMMOT_LIBRARY_OPTIONS})
  target_precompile_headers(${name} REUSE_FROM core_headers)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${SLAMMOT_JOIN_SOURCES} UNITY_BUILD_BATCH_SIZE 30)
  target_link_libraries(${name} PUBLIC ${ARG_LINK})
endfunction()

# slammot_headers(common_flow LINK common_geometry): a library without sources.
function(slammot_headers name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_library(${name} INTERFACE)
  target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(${name} INTERFACE cxx_std_20)
  target_link_libraries(${name} INTERFACE ${ARG_LINK})
endfunction()

# slammot_service(ingest SOURCES ingest.cpp ingest_service.cpp LINK ...): library service_ingest and, from
# main.cpp, the executable slammot-ingest.
function(slammot_service name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  slammot_library(service_${name} SOURCES ${ARG_SOURCES} LINK ${ARG_LINK})
  string(REPLACE "_" "-" dashed ${name})
  add_executable(slammot-${dashed} main.cpp)
  target_link_libraries(slammot-${dashed} PRIVATE service_${name} common_app)
  slammot_install_program(slammot-${dashed})
endfunction()

# slammot_test(unit_geometry SOURCES ... LINK ...): a GoogleTest executable whose tests ctest knows one by one. What is
# tested is optimized in its own library; tests are built in half the time with less, and with their headers precompiled.
# Sources are compiled together as those of a library; APART are those with names that others have, too.
# SLAMMOT_TEST_LABEL is a label besides; `ninja tests_LABEL` builds the programs that have it.
function(slammot_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;APART;LINK;LABELS" ${ARGN})
  set_source_files_properties(${ARG_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 60)
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  math(EXPR limit_s "${ARG_TIMEOUT} * ${SLAMMOT_TEST_PATIENCE}")
  add_executable(${name} ${ARG_SOURCES} ${ARG_APART})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_options(${name} PRIVATE ${SLAMMOT_TEST_OPTIONS})
  target_precompile_headers(${name} REUSE_FROM test_headers)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${SLAMMOT_JOIN_SOURCES} UNITY_BUILD_BATCH_SIZE 6)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT ${limit_s} LABELS "${ARG_LABELS}")
  if(SLAMMOT_TEST_LABEL)  # by a file of its own: gtest_discover_tests takes lists apart
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake
"if(${name}_TESTS)
  set_tests_properties(\${${name}_TESTS} PROPERTIES LABELS \"${ARG_LABELS};${SLAMMOT_TEST_LABEL}\")
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
    if(NOT TARGET tests_${SLAMMOT_TEST_LABEL})
      add_custom_target(tests_${SLAMMOT_TEST_LABEL})
    endif()
    add_dependencies(tests_${SLAMMOT_TEST_LABEL} ${name})
  endif()
endfunction()

# slammot_script_test(bench COMMAND ... LABELS integration TIMEOUT 300): a test that is no GoogleTest. Exit code 77 is
# "skipped": the test says why. WITHOUT_SANITIZERS "why" skips it where the code is built with any, ALONE keeps others
# from running beside it.
function(slammot_script_test name)
  cmake_parse_arguments(ARG "ALONE" "TIMEOUT;WORKING_DIRECTORY;WITHOUT_SANITIZERS" "COMMAND;LABELS" ${ARGN})
  if(SLAMMOT_SANITIZE AND ARG_WITHOUT_SANITIZERS)
    set(ARG_COMMAND sh -c "echo \"skipped under sanitizers: $0\" && exit 77" "${ARG_WITHOUT_SANITIZERS}")
  endif()
  math(EXPR limit_s "${ARG_TIMEOUT} * ${SLAMMOT_TEST_PATIENCE}")
  if(NOT ARG_WORKING_DIRECTORY)
    set(ARG_WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  add_test(NAME ${name} COMMAND ${ARG_COMMAND} WORKING_DIRECTORY ${ARG_WORKING_DIRECTORY})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${limit_s} SKIP_RETURN_CODE 77 RUN_SERIAL ${ARG_ALONE})
endfunction()
