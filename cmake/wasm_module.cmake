# The rows `wasm` and `wasm-threads` of the page of mssim web: WebAssembly modules of one source, if there are clang and wasm-ld. They
# have no C library. Of the host's they take headers, for templates and types; these ask for a list of functions that a 32-bit C library
# lacks: here an empty one.
find_program(WASM_CXX clang++)
find_program(WASM_LD wasm-ld)
mark_as_advanced(WASM_CXX WASM_LD)
set(wasm_folder ${CMAKE_BINARY_DIR}/wasm)
file(CONFIGURE OUTPUT ${wasm_folder}/gnu/stubs-32.h CONTENT "") # written only once: the module depends on it
file(WRITE ${wasm_folder}/try.cpp "#include <algorithm>\n#include <cmath>\n#include <string_view>\n#include <vector>\n")
set(wasm_flags --target=wasm32 -std=c++20 -O3 -msimd128 -mbulk-memory -ffp-contract=off -fno-math-errno -fno-exceptions -fno-rtti
  -fvisibility=hidden -nostdlib -Wl,--no-entry,--allow-undefined,--strip-all,--import-memory -I${wasm_folder})
foreach(folder ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
  if(NOT folder MATCHES "/(gcc|clang)/") # what is a compiler's own
    list(APPEND wasm_flags -isystem ${folder})
  endif()
endforeach()
set(wasm_modules ${CMAKE_BINARY_DIR}/share/mssim/spring_list.wasm ${CMAKE_BINARY_DIR}/share/mssim/spring_list_threads.wasm)
set(wasm_fails 1)
if(WASM_CXX AND WASM_LD)
  execute_process(COMMAND ${WASM_CXX} ${wasm_flags} ${wasm_folder}/try.cpp -o ${wasm_folder}/try.wasm
    RESULT_VARIABLE wasm_fails OUTPUT_FILE ${wasm_folder}/try.log ERROR_FILE ${wasm_folder}/try.log)
endif()
if(NOT wasm_fails EQUAL 0)
  message(STATUS "The page of mssim web gets no rows wasm and wasm-threads: clang++ and wasm-ld (Debian's clang and lld) are missing, or cannot compile "
    "(${wasm_folder}/try.log)")
  file(REMOVE ${wasm_modules})
  return()
endif()
set(wasm_source ${PROJECT_SOURCE_DIR}/src/web/module/spring_list.cpp)
foreach(wasm_module ${wasm_modules})
  get_filename_component(wasm_name ${wasm_module} NAME_WE)
  set(wasm_depfile ${wasm_folder}/${wasm_name}.d)
  add_custom_command(OUTPUT ${wasm_module} DEPENDS ${wasm_source} DEPFILE ${wasm_depfile}
    COMMAND ${WASM_CXX} ${wasm_flags} -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion $<$<BOOL:${CMAKE_COMPILE_WARNING_AS_ERROR}>:-Werror>
      -I${PROJECT_SOURCE_DIR}/src -I${PROJECT_SOURCE_DIR} -MD -MF ${wasm_depfile} -MT ${wasm_module} ${wasm_source} -o ${wasm_module}
    COMMENT "Building a module of the page" VERBATIM COMMAND_EXPAND_LISTS)
  # For the second: threads share its memory, and each gets a stack of its own. The page decides how much memory there may be, up to 4 GiB.
  list(APPEND wasm_flags -matomics -mmutable-globals -Wl,--shared-memory,--max-memory=4294967296,--export=__stack_pointer)
endforeach()
add_custom_target(wasm_module DEPENDS ${wasm_modules})
add_dependencies(mssim wasm_module)
install(FILES ${wasm_modules} DESTINATION ${CMAKE_INSTALL_DATADIR}/mssim)
