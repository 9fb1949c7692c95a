# Runs PROGRAM's [oclgrind] tests on the simulator Oclgrind, which sees data races, divergent barriers and accesses out
# of bounds, and fails where it has anything to say: Oclgrind itself exits with 0 whatever it finds.
#
# Its check of uninitialised values (OCLGRIND_UNINITIALIZED) is left out. In Oclgrind 21.10 it crashes on a shuffle whose
# result is longer or shorter than its operands (float4 to float8), and reports a vector that LLVM stores as undef and
# then fills component by component. The kernel tests poison what kernels write instead.
file(REMOVE "${LOG}")
set(ENV{OCL_ICD_VENDORS} "${OCLGRIND}")
set(ENV{OCLGRIND_DATA_RACES} 1)
set(ENV{OCLGRIND_LOG} "${LOG}")
set(ENV{OCLGRIND_BUILD_OPTIONS} "-DAPSL_PREFETCH(address)=")  # it has no prefetch
set(ENV{APSL_TEST_PLATFORM} Oclgrind)
unset(ENV{OCLGRIND_UNINITIALIZED})
unset(ENV{OCLGRIND_QUICK})
unset(ENV{APSL_TEST_DEVICE})
execute_process(COMMAND "${PROGRAM}" "[oclgrind]" --warn NoTests RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the tests failed on Oclgrind with ${result}")
endif()
if(EXISTS "${LOG}")
  file(SIZE "${LOG}" size)
  if(size GREATER 0)
    file(READ "${LOG}" findings LIMIT 4000)
    message(FATAL_ERROR "Oclgrind reports (all of it in ${LOG}):\n${findings}")
  endif()
endif()
