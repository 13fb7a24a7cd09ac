# The library for several processes, granperi-mpi, and its program: the same engine, with the files of src/mpi in place of
# src/without_mpi.cpp.
find_package(MPI REQUIRED COMPONENTS C CXX)
find_path(GRANPERI_ZOLTAN_INCLUDE_DIR zoltan.h PATH_SUFFIXES trilinos)
find_library(GRANPERI_ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
if(NOT GRANPERI_ZOLTAN_INCLUDE_DIR OR NOT GRANPERI_ZOLTAN_LIBRARY)
  message(FATAL_ERROR "GRANPERI_MPI=ON needs Zoltan (Debian: libtrilinos-zoltan-dev; scripts/install-dependencies mpi)")
endif()

function(granperi_make_mpi_objects target)
  add_library(${target} OBJECT src/mpi/mpi_api.cpp src/mpi/mpi_crossing.cpp src/mpi/zoltan_cut.cpp)
  granperi_compile_engine(${target})
  target_compile_definitions(${target} PRIVATE GP_WITH_MPI OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
  target_include_directories(${target} SYSTEM PRIVATE ${MPI_C_INCLUDE_DIRS} ${GRANPERI_ZOLTAN_INCLUDE_DIR})
endfunction()

granperi_make_mpi_objects(granperi_mpi_objects)
target_compile_options(granperi_mpi_objects PRIVATE ${GRANPERI_MARCH})
add_library(granperi_mpi_interface OBJECT src/load_symbol.cpp)
granperi_compile_engine(granperi_mpi_interface)
set(GRANPERI_MPI_ENGINE "")
if(GRANPERI_LEVELS)
  granperi_make_mpi_objects(granperi_mpi_objects_v3)
  target_compile_options(granperi_mpi_objects_v3 PRIVATE -march=x86-64-v3)
  target_sources(granperi_mpi_interface PRIVATE src/levels/dispatch.cpp)
  target_compile_definitions(granperi_mpi_interface PRIVATE GP_WITH_MPI OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
  target_include_directories(granperi_mpi_interface SYSTEM PRIVATE ${MPI_C_INCLUDE_DIRS})
  granperi_make_level(base granperi_objects granperi_mpi_objects GRANPERI_MPI_ENGINE)
  granperi_make_level(v3 granperi_objects_v3 granperi_mpi_objects_v3 GRANPERI_MPI_ENGINE)
else()
  set(GRANPERI_MPI_ENGINE $<TARGET_OBJECTS:granperi_objects> $<TARGET_OBJECTS:granperi_mpi_objects>)
endif()

add_library(granperi_mpi SHARED ${GRANPERI_MPI_ENGINE} $<TARGET_OBJECTS:granperi_mpi_interface>)
add_library(granperi::granperi_mpi ALIAS granperi_mpi)
set_target_properties(granperi_mpi PROPERTIES OUTPUT_NAME granperi-mpi VERSION ${PROJECT_VERSION} SOVERSION ${GRANPERI_SOVERSION}
                                              LINKER_LANGUAGE CXX LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/granperi.map)
target_link_options(granperi_mpi PRIVATE "LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/granperi.map" "LINKER:--as-needed"
                                         "LINKER:-z,nodelete")
target_include_directories(granperi_mpi PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(granperi_mpi PUBLIC MPI::MPI_C PRIVATE ${GRANPERI_ZOLTAN_LIBRARY} ${GRANPERI_PRIVATE_LIBRARIES})
if(GRANPERI_HDF5)
  target_link_libraries(granperi_mpi PRIVATE ${HDF5_C_LIBRARIES})
endif()

add_executable(granperi_mpi_program programs/granperi-mpi.c)
file(RELATIVE_PATH GRANPERI_MPI_RPATH "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set_target_properties(granperi_mpi_program PROPERTIES OUTPUT_NAME granperi-mpi INSTALL_RPATH "$ORIGIN/${GRANPERI_MPI_RPATH}")
target_link_libraries(granperi_mpi_program PRIVATE granperi_mpi m)

# ------------------------------------------------------------------------------------------------- install

install(TARGETS granperi_mpi EXPORT granperi-mpi-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS granperi_mpi_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES include/granperi/gp_mpi.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/granperi)
install(EXPORT granperi-mpi-targets NAMESPACE granperi:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/granperi)
# Relative, as in granperi.pc.
file(RELATIVE_PATH GRANPERI_PC_PREFIX "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
file(RELATIVE_PATH GRANPERI_PC_INCLUDEDIR "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
set(GRANPERI_PC_MPI_CFLAGS "")
foreach(directory ${MPI_C_INCLUDE_DIRS})
  string(APPEND GRANPERI_PC_MPI_CFLAGS " -I${directory}")
endforeach()
list(JOIN MPI_C_LIBRARIES " " GRANPERI_PC_MPI_LIBS)
configure_file(pkgconfig/granperi-mpi.pc.in granperi-mpi.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/granperi-mpi.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
