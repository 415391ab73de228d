# Debian packages, one for each role of a computer: cpack -G DEB, or deploy/debs. Units, configuration and maintainer scripts are in
# packages only, not in cmake --install.

set(units_folder lib/systemd/system)
set(control_folder ${PROJECT_BINARY_DIR}/debian)

install(FILES deploy/systemd/slammot@.service deploy/systemd/slammot.target DESTINATION ${units_folder}
        COMPONENT common EXCLUDE_FROM_ALL)
install(PROGRAMS deploy/systemd/restart-pause DESTINATION lib/slammot COMPONENT common EXCLUDE_FROM_ALL)
install(FILES deploy/etc/slammot.env deploy/etc/settings.textproto DESTINATION /etc/slammot COMPONENT common EXCLUDE_FROM_ALL)
install(FILES docs/operations.md DESTINATION share/doc/slammot-common COMPONENT common EXCLUDE_FROM_ALL)
install(FILES deploy/etc/ingest.env DESTINATION /etc/slammot COMPONENT sensors EXCLUDE_FROM_ALL)
install(DIRECTORY deploy/systemd/slammot@ingest.service.d DESTINATION ${units_folder} COMPONENT sensors EXCLUDE_FROM_ALL)
install(FILES LICENSE DESTINATION share/doc/slammot RENAME copyright COMPONENT everything EXCLUDE_FROM_ALL)

# What slammot.target starts. Ingest and recorder first need to be told what to play and where to write: systemctl enable.
foreach(role IN LISTS SLAMMOT_ROLES)
  foreach(service IN LISTS SLAMMOT_SERVICES_${role})
    if(NOT service MATCHES "ingest|recorder")
      set(link ${control_folder}/wants/slammot@${service}.service)
      file(MAKE_DIRECTORY ${control_folder}/wants)
      file(CREATE_LINK ../slammot@.service ${link} SYMBOLIC)
      install(FILES ${link} DESTINATION ${units_folder}/slammot.target.wants COMPONENT ${role} EXCLUDE_FROM_ALL)
    endif()
  endforeach()
endforeach()

# slammot_package(estimation DESCRIPTION "..." DEPENDS "slammot-common" CONFFILES /etc/slammot/a.env)
function(slammot_package component)
  cmake_parse_arguments(ARG "" "NAME;DESCRIPTION;DEPENDS;RECOMMENDS" "CONTROL" ${ARGN})
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_COMPONENT_${COMPONENT}_DESCRIPTION "${ARG_DESCRIPTION}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${ARG_NAME} PARENT_SCOPE)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_CONTROL_EXTRA "${ARG_CONTROL}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_CONTROL_STRICT_PERMISSION TRUE PARENT_SCOPE)
endfunction()

# Maintainer scripts of a role: its services are restarted by an upgrade, if they run, and stopped by a removal.
function(slammot_role_scripts role)
  list(TRANSFORM SLAMMOT_SERVICES_${role} REPLACE "(.+)" "slammot@\\1.service" OUTPUT_VARIABLE units)
  list(JOIN units " " SLAMMOT_UNITS)
  foreach(script postinst prerm postrm)
    configure_file(deploy/packaging/role.${script}.in ${control_folder}/${role}/${script} @ONLY
                   FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endforeach()
endfunction()

foreach(role IN LISTS SLAMMOT_ROLES)
  slammot_role_scripts(${role})
  set(control_of_${role} ${control_folder}/${role}/postinst ${control_folder}/${role}/prerm ${control_folder}/${role}/postrm)
endforeach()
list(APPEND control_of_sensors ${PROJECT_SOURCE_DIR}/deploy/packaging/sensors/conffiles)
set(common_control ${PROJECT_SOURCE_DIR}/deploy/packaging/common)

slammot_package(common NAME slammot-common DEPENDS adduser
  DESCRIPTION "Units, configuration and profiles of slammot"
  CONTROL ${common_control}/postinst ${common_control}/postrm ${common_control}/conffiles)
slammot_package(sensors NAME slammot-sensors DEPENDS slammot-common
  DESCRIPTION "Sources of laser scans and odometry: ingest" CONTROL ${control_of_sensors})
slammot_package(estimation NAME slammot-estimation DEPENDS slammot-common
  DESCRIPTION "Localization, detection and tracking of moving objects, collision warning" CONTROL ${control_of_estimation})
slammot_package(closing NAME slammot-closing DEPENDS slammot-common
  DESCRIPTION "Loop closing and map store" CONTROL ${control_of_closing})
slammot_package(view NAME slammot-view DEPENDS slammot-common
  DESCRIPTION "Live view in the browser, and recorder" CONTROL ${control_of_view})
slammot_package(tools NAME slammot-tools DEPENDS slammot-common
  RECOMMENDS "slammot-sensors, slammot-estimation, slammot-closing"
  DESCRIPTION "The command slammot: batch runs, inspection of the bus, simulator")
slammot_package(everything NAME slammot DEPENDS "slammot-sensors, slammot-estimation, slammot-closing, slammot-view, slammot-tools"
  DESCRIPTION "All of slammot: SLAM with detection and tracking of moving objects")
slammot_package(development NAME slammot-dev DEPENDS "libeigen3-dev, libceres-dev"
  DESCRIPTION "Estimation of slammot as libraries for other projects")

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL common sensors estimation closing view tools everything development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "slammot maintainers <slammot@localhost>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/debs)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
set(CPACK_THREADS 2)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packing builds nothing
include(CPack)
