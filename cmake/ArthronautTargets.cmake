# The helpers every CMakeLists.txt of the tree uses, and the rules that they enforce:
#   app -> navigation -> planning, never back; one library a module; warnings, sanitizers and standard in one place.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set_property(GLOBAL PROPERTY GLOBAL_DEPENDS_NO_CYCLES ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(ARTHRONAUT_CCACHE ccache)
if(ARTHRONAUT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths count from the source tree: a second clone or work tree takes what the first one compiled. What ccache may
  # overlook is what keeps it from precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=true
    CCACHE_SLOPPINESS=pch_defines,time_macros ${ARTHRONAUT_CCACHE})
endif()

# lld links the VTK and CGAL objects several times faster than the default linker.
find_program(ARTHRONAUT_LLD ld.lld)
if(ARTHRONAUT_LLD)
  add_link_options(-fuse-ld=lld)
endif()

add_library(arthronaut_compile_options INTERFACE)
target_compile_options(arthronaut_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  $<$<BOOL:${ARTHRONAUT_WARNINGS_AS_ERRORS}>:-Werror>
  # Where several sources are compiled as one, GCC takes none of them for the main file of what it hides.
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
  # GCC 12, where it optimises most, takes "a" + std::string for a copy onto itself, and strings and vectors that grow
  # for reads and writes beyond their end.
  "$<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")
target_include_directories(arthronaut_compile_options INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/generated)
if(ARTHRONAUT_SANITIZER STREQUAL "address")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(ARTHRONAUT_SANITIZER STREQUAL "fuzzer")
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "ARTHRONAUT_SANITIZER=fuzzer needs Clang: its libFuzzer is what is built for")
  endif()
  add_compile_options(-fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(ARTHRONAUT_SANITIZER STREQUAL "thread")
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread)
elseif(NOT ARTHRONAUT_SANITIZER STREQUAL "")
  message(FATAL_ERROR "ARTHRONAUT_SANITIZER must be empty, 'address', 'thread' or 'fuzzer'")
endif()

function(arthronaut_let_ccache_see_precompiled name)
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

# What nearly every source includes, and what takes a third of its compilation, is compiled once where all is compiled
# from nothing. Where sources are worked on it would hide a header that is not included.
set(ARTHRONAUT_COMMON_HEADERS <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <numbers>
  <optional> <random> <set> <span> <sstream> <string> <thread> <vector> <Eigen/Geometry>)
if(CMAKE_UNITY_BUILD)
  file(CONFIGURE OUTPUT common_headers.cpp CONTENT "")
  add_library(common_headers OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/common_headers.cpp)
  target_link_libraries(common_headers PRIVATE arthronaut_compile_options Eigen3::Eigen)
  target_precompile_headers(common_headers PRIVATE ${ARTHRONAUT_COMMON_HEADERS})
  arthronaut_let_ccache_see_precompiled(common_headers)
endif()
function(arthronaut_precompile name)
  if(CMAKE_UNITY_BUILD)
    target_precompile_headers(${name} REUSE_FROM common_headers)
    arthronaut_let_ccache_see_precompiled(${name})
  endif()
endfunction()

# arthronaut_library(planning_bones SOURCES a.cpp ... PUBLIC libs... PRIVATE libs...)
# Declares a module. The name's first word is the layer; a link that points up the layers stops the configuration.
# APART: those of its sources that name things of their own as another one does. CI, which compiles several sources as
# one, compiles these by themselves.
function(arthronaut_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;APART" ${ARGN})
  arthronaut_check_layers(${name} ${ARG_PUBLIC} ${ARG_PRIVATE})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE arthronaut_compile_options ${ARG_PRIVATE})
    target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
    arthronaut_compile_apart(${ARG_APART})
    arthronaut_precompile(${name})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC})
    target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
  endif()
endfunction()

function(arthronaut_compile_apart)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

function(arthronaut_check_layers name)
  foreach(lib IN LISTS ARGN)
    if((name MATCHES "^planning_" AND lib MATCHES "^(navigation|app)_") OR
       (name MATCHES "^navigation_" AND lib MATCHES "^app_"))
      message(FATAL_ERROR "${name} may not link ${lib}: app -> navigation -> planning, never back")
    endif()
    if(NOT name MATCHES "^app_" AND lib MATCHES "(glfw|imgui|GLEW|VTK::Rendering)")
      message(FATAL_ERROR "${name} may not link ${lib}: windows and rendering live in app alone")
    endif()
  endforeach()
endfunction()

# Half of what is compiled from nothing are test programs, and a third of that is to optimise what runs but once.
# What is tested, and what is measured, keeps its own optimisation.
set(ARTHRONAUT_TEST_OPTIMISATION $<$<BOOL:${CMAKE_UNITY_BUILD}>:-O1>)

# arthronaut_test(navigation_camera SOURCES x_test.cpp ... LIBS libs...)
# One test program a module; ctest runs each suite of it on its own, in one process: what is made ready once for all
# cases of a suite is made once. BY_CASE: each case on its own, where cases are long and share nothing. APART as above.
# ALONE: while one of its suites runs, no other test does. WAITS: for another process, a stream or its own clock, most of
# the time: ./test runs two of these in the place of one that computes. CASE_S: about how long a case takes, so that long ones begin
# first (1). TIMEOUT_S: of what runs on its own.
function(arthronaut_test name)
  if(NOT ARTHRONAUT_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "ALONE;BY_CASE;WAITS" "TIMEOUT_S;CASE_S" "SOURCES;LIBS;LABELS;APART" ${ARGN})
  if(NOT ARG_TIMEOUT_S)
    set(ARG_TIMEOUT_S 900)
  endif()
  if(NOT ARG_CASE_S)
    set(ARG_CASE_S 1)
  endif()
  add_executable(${name}_test ${ARG_SOURCES})
  target_compile_options(${name}_test PRIVATE ${ARTHRONAUT_TEST_OPTIMISATION})
  arthronaut_let_ccache_see_precompiled(${name}_test)
  target_precompile_headers(${name}_test REUSE_FROM test_headers)
  arthronaut_compile_apart(${ARG_APART})
  target_link_libraries(${name}_test PRIVATE arthronaut_compile_options ${ARG_LIBS} GTest::gtest_main GTest::gmock)
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  file(GENERATE OUTPUT ${suites} CONTENT "
set(name ${name})
set(program $<TARGET_FILE:${name}_test>)
set(working_directory ${CMAKE_CURRENT_BINARY_DIR})
set(timeout_s ${ARG_TIMEOUT_S})
set(case_s ${ARG_CASE_S})
set(is_alone ${ARG_ALONE})
set(waits ${ARG_WAITS})
set(by_case ${ARG_BY_CASE})
set(labels \"${ARG_LABELS}\")
include(${CMAKE_SOURCE_DIR}/cmake/TestSuites.cmake)
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
endfunction()

# arthronaut_benchmark(registration SOURCES x_benchmark.cpp LIBS libs...): built with the tests, run by hand.
function(arthronaut_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name}_benchmark ${ARG_SOURCES})
  target_link_libraries(${name}_benchmark PRIVATE arthronaut_compile_options ${ARG_LIBS} benchmark::benchmark_main)
endfunction()
