# SPDX-License-Identifier: BSL-1.0
# What is installed and packed. Component dev: find_package(quadrant), or with COMPONENTS diagnosis; pkg-config; the single
# file. Component programs: the programs with man page and completion.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/quadrant)
set(packaging ${PROJECT_SOURCE_DIR}/packaging)

install(TARGETS quadrant EXPORT quadrantTargets FILE_SET HEADERS COMPONENT dev)
install(EXPORT quadrantTargets NAMESPACE quadrant:: DESTINATION ${package_dir} COMPONENT dev)
install(TARGETS quadrant_diagnosis EXPORT quadrantDiagnosisTargets FILE_SET HEADERS COMPONENT dev)
install(EXPORT quadrantDiagnosisTargets NAMESPACE quadrant:: DESTINATION ${package_dir} COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/quadrantConfigVersion.cmake
  COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
install(FILES ${packaging}/quadrantConfig.cmake ${PROJECT_BINARY_DIR}/quadrantConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT dev)

# pkg-config finds its own place, so that the tree may be moved.
foreach(name IN ITEMS quadrant quadrant-diagnosis)
  configure_file(${packaging}/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig COMPONENT dev)
endforeach()

if(PROJECT_IS_TOP_LEVEL)
  find_package(Python3 COMPONENTS Interpreter)
  if(Python3_FOUND)
    set(single ${PROJECT_BINARY_DIR}/quadrant_single.hpp)
    add_custom_command(OUTPUT ${single}
      COMMAND ${Python3_EXECUTABLE} ${packaging}/single_header.py ${PROJECT_SOURCE_DIR}/include ${PROJECT_VERSION} ${single}
      DEPENDS ${packaging}/single_header.py ${core_headers} VERBATIM)
    add_custom_target(quadrant_single ALL DEPENDS ${single})
    install(FILES ${single} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
  else()
    message(STATUS "No Python 3: quadrant_single.hpp is not made")
  endif()
endif()

# A program, its man page written from its own help, and its completion, which asks it.
function(install_program program summary)
  if(NOT TARGET ${program})
    return()
  endif()
  string(REPLACE "-" "_" folder ${program})
  set(files ${PROJECT_SOURCE_DIR}/examples/programs/${folder})
  set(page ${PROJECT_BINARY_DIR}/${program}.1)
  set(writer ${PROJECT_SOURCE_DIR}/examples/programs/quadrant_gap/man_page.cmake)
  add_custom_command(OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DNAME=${program} -DSUMMARY=${summary}
      -DVERSION=${PROJECT_VERSION} -DMORE=${files}/man_page.txt -DOUT=${page} -P ${writer}
    DEPENDS ${program} ${writer} ${files}/man_page.txt VERBATIM)
  add_custom_target(${folder}_man ALL DEPENDS ${page})
  set(component programs)
  if(ARGC GREATER 2) # what needs a library that the others do not
    set(component ${ARGV2})
  endif()
  install(TARGETS ${program} COMPONENT ${component})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/examples/programs/quadrant_gap/quadrant-gap.bash COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
endfunction()
install_program(quadrant-gap "why does the machine not do what its simulation says?")
install_program(quadrant-gap-mpi "many machines on many hosts" mpi)
install_program(quadrant-reproduce "the experiments of the milling table, computed again")
install_program(quadrant-latency "does my loop fit my period, with what margin?")
install_program(quadrant-cnc "a part program through a virtual machine: tracking and contour errors")

# --- cpack -G DEB: libquadrant-dev, and quadrant-tools where the programs are built. ---
set(CPACK_PACKAGE_NAME quadrant)
set(CPACK_PACKAGE_CONTACT "Quadrant developers <quadrant@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL dev)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libquadrant-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS libboost-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "libeigen3-dev, nlohmann-json3-dev, libfmt-dev")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME quadrant-tools)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS gnuplot-nox)
set(CPACK_DEBIAN_MPI_PACKAGE_NAME quadrant-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "quadrant-tools, openmpi-bin")
if(TARGET quadrant-gap)
  list(APPEND CPACK_COMPONENTS_ALL programs)
endif()
if(TARGET quadrant-gap-mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
endif()
if(PROJECT_IS_TOP_LEVEL)
  include(CPack)
endif()
