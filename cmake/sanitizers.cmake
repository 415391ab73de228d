# Builds with sanitizers (presets asan-ubsan and tsan), and everything in which their tests differ: options, suppressions
# and time limits. What a test's own list says of it is in slammot_script_test.

set(SLAMMOT_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")

# Instrumented code takes 5 to 15 times as long: every time limit is multiplied by this, also those inside of tests.
set(SLAMMOT_TEST_PATIENCE 1)

if(SLAMMOT_SANITIZE)
  set(SLAMMOT_TEST_PATIENCE 10)
  # Reports name lines, for which -g1 suffices: a quarter less time to build than with -g.
  add_compile_options(-fsanitize=${SLAMMOT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -g1)
  # GCC loses track of what an optional holds in instrumented code. Without instrumentation this warning is an error as well.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # The thread sanitizer does not see the fences of Boost.Asio.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
  add_link_options(-fsanitize=${SLAMMOT_SANITIZE})

  # Read by ctest, so that every test and every process that a test starts has it.
  file(WRITE ${PROJECT_BINARY_DIR}/sanitizer_environment.cmake
"set(ENV{SLAMMOT_TEST_PATIENCE} ${SLAMMOT_TEST_PATIENCE})
set(ENV{TSAN_OPTIONS} \"suppressions=${PROJECT_SOURCE_DIR}/tests/sanitizers/tsan.supp:second_deadlock_stack=1\")
set(ENV{ASAN_OPTIONS} \"detect_stack_use_after_return=1:strict_string_checks=1\")
set(ENV{UBSAN_OPTIONS} \"print_stacktrace=1\")
")
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY TEST_INCLUDE_FILES ${PROJECT_BINARY_DIR}/sanitizer_environment.cmake)
endif()
