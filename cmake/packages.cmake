# Debian packages from a build, one per component (install.cmake): tools/package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME steplap)
set(CPACK_PACKAGE_VENDOR steplap)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake") # CPack's own: any other would stand before each package's
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The steplap developers <steplap@example.org>")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

# Name, section, dependencies other than shared libraries, description.
function(steplap_package component name section depends summary text)
  string(TOUPPER ${component} upper)
  foreach(setting "PACKAGE_NAME ${name}" "PACKAGE_SECTION ${section}" "PACKAGE_DEPENDS ${depends}")
    string(FIND "${setting}" " " blank)
    string(SUBSTRING "${setting}" 0 ${blank} key)
    math(EXPR blank "${blank} + 1")
    string(SUBSTRING "${setting}" ${blank} -1 value)
    set(CPACK_DEBIAN_${upper}_${key} "${value}" PARENT_SCOPE)
  endforeach()
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(packaged ${packaged} ${component} PARENT_SCOPE)
  # Files that every Debian package must have: copyright and changes.
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION share/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES cmake/debian/${name}.lintian-overrides DESTINATION share/lintian/overrides RENAME ${name} COMPONENT ${component} EXCLUDE_FROM_ALL OPTIONAL)
endfunction()

file(READ LICENSE licence)
string(REGEX MATCH "Copyright[^\n]*" steplap_copyright "${licence}")
string(REGEX REPLACE "^Copyright (\\(c\\) )?" "" steplap_copyright "${steplap_copyright}")
file(STRINGS tools/pages/plotly/LICENSE plotly_copyright REGEX "^Copyright")
string(REGEX REPLACE "^Copyright (\\([cC]\\) )?" "" plotly_copyright "${plotly_copyright}")
string(REGEX MATCH "Permission is hereby.*" steplap_permission "${licence}")
string(STRIP "${steplap_permission}" steplap_permission)
string(REPLACE "\n\n" "\n.\n" steplap_permission "${steplap_permission}")
string(REPLACE "\n" "\n " steplap_permission "${steplap_permission}")
configure_file(cmake/debian/copyright.in debian/copyright @ONLY)
configure_file(cmake/debian/changelog.in debian/changelog @ONLY)
execute_process(COMMAND gzip -9cn ${PROJECT_BINARY_DIR}/debian/changelog OUTPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog.gz)

set(packaged)
steplap_package(program steplap science "libudunits2-data" "planar multibody dynamics with honest friction"
"Describe bodies, joints, contacts and friction in a text file. steplap tells
what slides, tips or lifts, when, and how far, with an estimate of the error
of every result and a verdict. It was made for power transformers in transit.")
if(TARGET steplap-study)
  steplap_package(study steplap-study science "steplap (= ${PROJECT_VERSION}), libudunits2-data" "studies of planar machines: what if, how likely"
"Many runs of a model of steplap: probabilities of slip, sensitivities, limits
that are just held, fits to records; and assessments of shock recorders' files.")
endif()
steplap_package(development libsteplap-dev libdevel
  "libeigen3-dev, libtomlplusplus-dev, libudunits2-dev, libudunits2-data, libexpat1-dev, libssl-dev, libgmp-dev, libmpfr-dev, libasmjit-dev"
  "planar multibody dynamics with honest friction: library for C++"
"Headers, static libraries and the packages for CMake and pkg-config, for
programs that make, run and judge models as steplap does, to the same bits.")
if(TARGET steplap_python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/python/postinst;${PROJECT_SOURCE_DIR}/cmake/debian/python/prerm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "steplap, python3-pandas, python3-matplotlib") # studies, frames, plots
  steplap_package(python python3-steplap python "${STEPLAP_PYTHON_VERSIONS}, python3-numpy, libudunits2-data"
  "planar multibody dynamics with honest friction: module of Python"
"Models, runs and verdicts of steplap from Python: trajectories as arrays of
numpy without copies, many runs on all processors, errors with their places.")
endif()
# Targets that the packages contain, without tests: tools/package builds them.
add_custom_target(packaged)
foreach(target steplap steplap-study steplap_python)
  if(TARGET ${target})
    add_dependencies(packaged ${target})
  endif()
endforeach()
set(CPACK_COMPONENTS_ALL ${packaged})
include(CPack)
