# Installation of files by `cmake --install`, and the package that find_package(steplap) finds: docs/how-to/use_from_cpp.md. Each component
# is a Debian package (packages.cmake): program, study, development, python.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# One name for all libraries up to transformer/. A program that links it gets none of our compile options and warnings, and needs no other
# headers than Eigen's, which are part of our types. With BUILD_SHARED_LIBS it is one shared library that exports only steplap's names
# (steplap.map); otherwise it is the archives.
set(parts base tape mbd io run patch_exact patch elements machinery step_lap catalog recorder transformer)
list(TRANSFORM parts PREPEND steplap_ OUTPUT_VARIABLE archives)
add_library(steplap_library INTERFACE)
add_library(steplap::steplap ALIAS steplap_library)
target_compile_features(steplap_library INTERFACE cxx_std_20)
set_target_properties(steplap_library PROPERTIES EXPORT_NAME steplap)
if(BUILD_SHARED_LIBS)
  set(objects ${archives})
  list(TRANSFORM objects REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
  add_library(steplap_shared SHARED ${objects})
  target_link_libraries(steplap_shared PRIVATE ${archives}) # for what they are linked with: their own objects are there already
  target_link_libraries(steplap_shared INTERFACE Eigen3::Eigen)
  target_link_options(steplap_shared PRIVATE -Wl,--no-undefined -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/steplap.map)
  set_target_properties(steplap_shared PROPERTIES OUTPUT_NAME steplap VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} EXPORT_NAME shared LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/steplap.map)
  target_link_libraries(steplap_library INTERFACE steplap_shared)
  set(libraries steplap_shared steplap_library)
  set(steplap_pc_libraries "-lsteplap")
else()
  target_link_libraries(steplap_library INTERFACE steplap_transformer)
  set(libraries ${archives} steplap_library)
  foreach(part ${parts})
    set_target_properties(steplap_${part} PROPERTIES EXPORT_NAME ${part})
  endforeach()
  list(REVERSE archives)
  list(TRANSFORM archives PREPEND -l)
  list(JOIN archives " " steplap_pc_libraries)
  set(steplap_pc_libraries "-Wl,--start-group ${steplap_pc_libraries} -Wl,--end-group")
  set(steplap_pc_private "-ltomlplusplus -ludunits2 -lexpat -lcrypto -lgmp -lmpfr -lpthread -ldl")
  if(STEPLAP_MACHINE_CODE)
    string(APPEND steplap_pc_private " -lasmjit")
  endif()
endif()

# Programs include <steplap/model.h>; the headers behind it include each other as "mbd/…".
install(TARGETS ${libraries} EXPORT steplap COMPONENT development
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${CMAKE_INSTALL_INCLUDEDIR}/steplap/internal)
include(cmake/public_headers.cmake)
get_property(public_headers GLOBAL PROPERTY STEPLAP_PUBLIC_HEADERS)
get_property(public_sources GLOBAL PROPERTY STEPLAP_PUBLIC_SOURCES)
install(FILES ${public_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/steplap COMPONENT development)
install(CODE "
  set(STEPLAP_FUNCTIONS_ONLY ON)
  include(\"${PROJECT_SOURCE_DIR}/cmake/public_headers.cmake\")
  steplap_included_headers(headers \"${PROJECT_SOURCE_DIR}\" ${public_sources})
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/steplap/internal/\${folder}\"
      TYPE FILE FILES \"${PROJECT_SOURCE_DIR}/\${header}\")
  endforeach()" COMPONENT development)
configure_file(cmake/version.h.in version.h @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/steplap COMPONENT development)
file(RELATIVE_PATH steplap_pc_up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /) # wherever it is installed or moved to
configure_file(cmake/steplap.pc.in steplap.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/steplap.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
install(TARGETS steplap RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# bin/steplap searches for it at ../libexec, also in the build tree.
if(TARGET steplap-study)
  install(TARGETS steplap-study RUNTIME DESTINATION libexec COMPONENT study)
endif()
install(DIRECTORY models docs/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/steplap COMPONENT program)
install(FILES tools/editors/steplap.lua tools/editors/taplo_lsp.js DESTINATION ${CMAKE_INSTALL_DATADIR}/steplap/editors COMPONENT program)
install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/steplap COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/steplap COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" REGEX "/cookbook/[^/]*\\.toml$")
# Licence notices of the packages that each component contains code of. The third column of the table names the components; the program and
# the Python module are linked with the library.
set(steplap_notices_program steplap "library|programs")
set(steplap_notices_study steplap-study "library|programs|steplap-study")
set(steplap_notices_development libsteplap-dev "library")
set(steplap_notices_python python3-steplap "library|module of Python")
file(STRINGS THIRD_PARTY.md rows REGEX "^\\| [a-z0-9.+-]+ \\|")
foreach(row ${rows})
  string(REGEX REPLACE "^\\| ([^ |]+) \\|[^|]*\\|([^|]*)\\|.*" "\\1;\\2" columns "${row}")
  list(GET columns 0 package)
  list(GET columns 1 contained_in)
  foreach(component program study development python)
    list(GET steplap_notices_${component} 0 folder)
    list(GET steplap_notices_${component} 1 parts)
    if(contained_in MATCHES "${parts}" AND EXISTS /usr/share/doc/${package}/copyright)
      install(FILES /usr/share/doc/${package}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${folder}/third_party RENAME ${package} COMPONENT ${component})
    endif()
  endforeach()
endforeach()
# Completions, man pages and the complete reference are made from the program's own texts when it is installed.
find_program(STEPLAP_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(STEPLAP_PYTHON3)
  install(CODE "execute_process(COMMAND \"${STEPLAP_PYTHON3}\" \"${PROJECT_SOURCE_DIR}/tools/site/shell_files\"
    \"$<TARGET_FILE:steplap>\" \"${CMAKE_CURRENT_BINARY_DIR}/shell\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
  install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/shell/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)
  # The complete reference replaces the short pages of the same name, installed above.
  install(CODE "execute_process(COMMAND \"${STEPLAP_PYTHON3}\" \"${PROJECT_SOURCE_DIR}/tools/site/reference_pages\"
    \"$<TARGET_FILE:steplap>\" \"${CMAKE_CURRENT_BINARY_DIR}/reference\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
  install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/reference/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/steplap/docs/reference COMPONENT program)
endif()
install(FILES tools/pages/plotly/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/steplap-study/third_party RENAME plotly COMPONENT study)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/steplap)
install(EXPORT steplap NAMESPACE steplap:: FILE steplapTargets.cmake DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/steplapConfig.cmake.in steplapConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(steplapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/steplapConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/steplapConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)
