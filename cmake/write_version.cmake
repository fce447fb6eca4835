# Writes version.c with version and commit; touches it only when it changes. In: SOURCE_DIR, VERSION, OUTPUT.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=10 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR commit STREQUAL "")
  set(commit "unknown")
endif()
set(text "#include \"ballpark.h\"\n
const char *bp_version(void) { return \"${VERSION} (commit ${commit})\"; }
int bp_api_version(void) { return BP_API_VERSION; }\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
