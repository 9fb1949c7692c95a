# What every target of ours has in common; nothing global, so that an embedding project keeps its own flags.
function(apsl_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  # Old interfaces are what OpenCL 1.2 platforms have. Ours alone: an embedding program targets what it likes.
  target_compile_definitions(${target} PRIVATE CL_TARGET_OPENCL_VERSION=120)
  # What an embedding project may have asked of all its code: no infinity and NaN, no exceptions, several files as one.
  # The checks of numbers need the first, errors the second, and names within a file the third.
  target_compile_options(${target} PRIVATE -fno-fast-math $<$<COMPILE_LANGUAGE:CXX>:-fexceptions>)
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    $<$<BOOL:${APSL_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
