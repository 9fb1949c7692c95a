# Runs the TESTS (a Catch2 selection) of PROGRAM on the simulator Oclgrind, which sees data races, divergent barriers,
# accesses out of bounds, wrong API calls and, with UNINITIALIZED, values that nobody wrote. Fails where it has anything to
# say: Oclgrind itself exits with 0 whatever it finds.
#
# What UNINITIALIZED is not for, all of it Oclgrind 21.10's own: it crashes on some vectors (a shuffle of float4 to float8
# among others), and reports those that LLVM stores as undef and then fills component by component. And it takes what
# clEnqueueWriteBuffer wrote for uninitialised: kernel tests make a buffer anew instead (GuardedMemory::write).
if(NOT EXISTS "${OCLGRIND}")
  message("SKIPPED: Oclgrind is not installed (Debian 12 has it, Debian 13 does not)")
  return()
endif()
file(REMOVE "${LOG}")
set(ENV{OCL_ICD_VENDORS} "${OCLGRIND}")
set(ENV{OCLGRIND_DATA_RACES} 1)
set(ENV{OCLGRIND_CHECK_API} 1)
set(ENV{OCLGRIND_LOG} "${LOG}")
set(ENV{OCLGRIND_BUILD_OPTIONS} "-DAPSLK_PREFETCH(address)=")  # it has no prefetch
set(ENV{APSL_TEST_PLATFORM} Oclgrind)
unset(ENV{OCLGRIND_QUICK})
unset(ENV{OCLGRIND_UNINITIALIZED})
unset(ENV{APSL_TEST_DEVICE})
if(UNINITIALIZED)
  set(ENV{OCLGRIND_UNINITIALIZED} 1)
endif()
execute_process(COMMAND "${PROGRAM}" "${TESTS}" ${REFUSE_NO_TESTS} RESULT_VARIABLE result)
if(EXISTS "${LOG}")
  file(SIZE "${LOG}" size)
  if(size GREATER 0)
    file(READ "${LOG}" findings LIMIT 4000)
    message(FATAL_ERROR "Oclgrind reports (all of it in ${LOG}):\n${findings}")
  endif()
else()
  message(FATAL_ERROR "no ${LOG}: the tests did not run on Oclgrind")
endif()
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the tests failed on Oclgrind with ${result}")
endif()
