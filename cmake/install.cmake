# cmake --install: programs with their profiles and scenarios, and the algorithm ring as libraries for other projects (component
# development), by find_package(slammot CONFIG) or pkg-config. Each component is a Debian package (cmake/packages.cmake). Tried by
# tests/install.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(SLAMMOT_INSTALLED_HEADERS ${CMAKE_INSTALL_INCLUDEDIR}/slammot)

# slammot_install_library(geometry): common_geometry of common/geometry, as slammot::geometry. In the order of dependence.
function(slammot_install_library folder)
  set(target common_${folder})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} OUTPUT_NAME slammot_${folder})
  add_library(slammot::${folder} ALIAS ${target})
  install(TARGETS ${target} EXPORT slammot ARCHIVE COMPONENT development
          INCLUDES DESTINATION ${SLAMMOT_INSTALLED_HEADERS})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/common/${folder} DESTINATION ${SLAMMOT_INSTALLED_HEADERS}/common
          COMPONENT development FILES_MATCHING PATTERN *.hpp)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    set_property(GLOBAL APPEND PROPERTY SLAMMOT_INSTALLED_ARCHIVES slammot_${folder})
  endif()
endfunction()

# The role of a computer that runs a service; other programs are tools.
set(SLAMMOT_SERVICES_sensors ingest)
set(SLAMMOT_SERVICES_estimation localization detection tracking collision-warning)
set(SLAMMOT_SERVICES_closing loop-closing map-store)
set(SLAMMOT_SERVICES_view gateway recorder)
set(SLAMMOT_ROLES sensors estimation closing view)

# slammot_install_program(slammot): also part of `ninja executables`.
function(slammot_install_program target)
  add_dependencies(executables ${target})
  set(component tools)
  foreach(role IN LISTS SLAMMOT_ROLES)
    list(TRANSFORM SLAMMOT_SERVICES_${role} PREPEND slammot- OUTPUT_VARIABLE programs)
    if(target IN_LIST programs)
      set(component ${role})
    endif()
  endforeach()
  install(TARGETS ${target} RUNTIME COMPONENT ${component})
endfunction()

# The files by which other projects find the libraries. Called once all libraries are known.
function(slammot_install_package)
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/slammot)
  install(EXPORT slammot NAMESPACE slammot:: FILE slammot-targets.cmake DESTINATION ${package_folder} COMPONENT development)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/slammot-config.cmake.in
                                ${PROJECT_BINARY_DIR}/slammot-config.cmake INSTALL_DESTINATION ${package_folder})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/slammot-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/slammot-config.cmake ${PROJECT_BINARY_DIR}/slammot-config-version.cmake
          DESTINATION ${package_folder} COMPONENT development)

  get_property(archives GLOBAL PROPERTY SLAMMOT_INSTALLED_ARCHIVES)
  list(REVERSE archives)  # a linker wants those that need others first
  list(TRANSFORM archives PREPEND -l)
  list(JOIN archives " " SLAMMOT_PC_LIBS)
  set(pc_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  file(RELATIVE_PATH SLAMMOT_PC_PREFIX /${pc_folder} /)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/slammot.pc.in ${PROJECT_BINARY_DIR}/slammot.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/slammot.pc DESTINATION ${pc_folder} COMPONENT development)
endfunction()

# Where the programs look for them: common/config/profiles.hpp.
install(DIRECTORY deploy/profiles deploy/dds DESTINATION ${CMAKE_INSTALL_DATADIR}/slammot COMPONENT common)
install(DIRECTORY deploy/scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/slammot COMPONENT tools)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT common)
