# The engine for several instruction sets in one library, GRANPERI_LEVEL=all: all of its files are compiled once for each. What
# comes of it is linked into one object, in which every name but that of its table of the interface's functions (src/levels/table.cpp)
# is made local: else the linker would take the one std::vector's member that it keeps from the files for AVX2, and the library
# would end with an illegal instruction on processors without. src/levels/dispatch.cpp hands the calls on.
#
# Two of them: x86-64-v4 (AVX-512) is no faster (docs/hot-path.md), and each costs the time of a build.
#
# Sets GRANPERI_LEVELS (ON with several), GRANPERI_ENGINE (what libraries are made of), GRANPERI_MARCH (an option, or nothing).

# Whether the compiler's own instruction set is below x86-64-v3, and the tools can do it.
include(CheckCXXSourceCompiles)
unset(GRANPERI_PLAIN_X86_64 CACHE) # CMAKE_CXX_FLAGS may have changed
set(CMAKE_REQUIRED_QUIET ON)
check_cxx_source_compiles("#if !defined(__x86_64__) || !defined(__ELF__) || defined(__ILP32__) || defined(__AVX2__)
#error other
#endif
int main() {}" GRANPERI_PLAIN_X86_64)
unset(CMAKE_REQUIRED_QUIET)
set(relink "") # the linker for that; for clang CMake names lld, which learned it in version 19, where clang itself takes GNU's
foreach(linker ${CMAKE_LINKER} ld.bfd ld)
  execute_process(COMMAND ${linker} --help OUTPUT_VARIABLE help ERROR_QUIET)
  if(NOT relink AND help MATCHES "--force-group-allocation.*elf64-x86-64")
    set(relink ${linker})
  endif()
endforeach()
if(GRANPERI_PLAIN_X86_64 AND CMAKE_OBJCOPY AND relink)
  set(levels_possible ON)
else()
  set(levels_possible OFF)
endif()

set(GRANPERI_LEVELS OFF)
set(GRANPERI_MARCH "")
if(GRANPERI_LEVEL STREQUAL "auto")
  if(levels_possible AND NOT GRANPERI_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug") # which take long enough for one
    set(GRANPERI_LEVELS ON)
  endif()
elseif(GRANPERI_LEVEL STREQUAL "all")
  if(NOT levels_possible)
    message(FATAL_ERROR "GRANPERI_LEVEL=all needs a compiler for x86-64 that is not told of AVX2, GNU ld and objcopy: CMAKE_LINKER is "
                        "${CMAKE_LINKER}, CMAKE_OBJCOPY ${CMAKE_OBJCOPY}")
  endif()
  set(GRANPERI_LEVELS ON)
elseif(NOT GRANPERI_LEVEL STREQUAL "one")
  set(GRANPERI_MARCH "-march=${GRANPERI_LEVEL}")
endif()

target_compile_options(granperi_objects PRIVATE ${GRANPERI_MARCH})
target_compile_options(granperi_one_process PRIVATE ${GRANPERI_MARCH})
if(NOT GRANPERI_LEVELS)
  set(GRANPERI_ENGINE $<TARGET_OBJECTS:granperi_objects> $<TARGET_OBJECTS:granperi_one_process>)
  return()
endif()

# Names can be made local in machine code alone, and not if they are for the whole process (STB_GNU_UNIQUE).
function(granperi_compile_for_level objects)
  target_compile_definitions(${objects} PRIVATE "GP_LEVELS=\"x86-64 or x86-64-v3\"")
  target_compile_options(${objects} PRIVATE -fno-lto $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  set_target_properties(${objects} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
endfunction()

# One level of the engine as one object with one name, in the list `engine`: of its objects and those of `rest`, which has the table
# of its functions.
function(granperi_make_level level objects rest engine)
  set(table granperi_level_${level})
  target_sources(${rest} PRIVATE ${PROJECT_SOURCE_DIR}/src/levels/table.cpp)
  target_compile_definitions(${rest} PRIVATE GP_LEVEL_TABLE=${table})
  granperi_compile_for_level(${rest})
  set(whole ${PROJECT_BINARY_DIR}/${rest}_level.o)
  add_custom_command(
    OUTPUT ${whole}
    COMMAND ${relink} -r --force-group-allocation -o ${whole} $<TARGET_OBJECTS:${objects}> $<TARGET_OBJECTS:${rest}>
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${table} ${whole}
    DEPENDS ${objects} ${rest} $<TARGET_OBJECTS:${objects}> $<TARGET_OBJECTS:${rest}>
    COMMENT "Making the names of ${rest} local" COMMAND_EXPAND_LISTS VERBATIM)
  set(${engine} ${${engine}} ${whole} PARENT_SCOPE)
endfunction()

add_library(granperi_objects_v3 OBJECT ${GRANPERI_SOURCES})
granperi_compile_engine(granperi_objects_v3)
target_compile_options(granperi_objects_v3 PRIVATE -march=x86-64-v3)
target_sources(granperi_interface PRIVATE src/levels/dispatch.cpp)
set(GRANPERI_ENGINE "")
add_library(granperi_one_process_v3 OBJECT src/without_mpi.cpp)
granperi_compile_engine(granperi_one_process_v3)
target_compile_options(granperi_one_process_v3 PRIVATE -march=x86-64-v3)
granperi_compile_for_level(granperi_objects)
granperi_compile_for_level(granperi_objects_v3)
granperi_make_level(base granperi_objects granperi_one_process GRANPERI_ENGINE)
granperi_make_level(v3 granperi_objects_v3 granperi_one_process_v3 GRANPERI_ENGINE)
add_custom_target(granperi_levels DEPENDS ${GRANPERI_ENGINE}) # one rule for two libraries
