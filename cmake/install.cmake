# What `cmake --install` puts where, and the package that find_package(steplap) finds: docs/library.md.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# One name for all rooms below tools/. Whoever links it gets no options of ours, no warnings, and of other makers'
# headers Eigen's alone, whose vectors our own types are made of.
add_library(steplap_library INTERFACE)
add_library(steplap::steplap ALIAS steplap_library)
target_link_libraries(steplap_library INTERFACE steplap_transformer)
target_compile_features(steplap_library INTERFACE cxx_std_20)

set(rooms math tape mbd io patch_exact patch elements transformer library)
list(TRANSFORM rooms PREPEND steplap_ OUTPUT_VARIABLE libraries)
foreach(room ${rooms})
  set_target_properties(steplap_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()
set_target_properties(steplap_library PROPERTIES EXPORT_NAME steplap)

# Headers include each other as "mbd/…", users write <steplap/mbd/…>.
install(TARGETS ${libraries} EXPORT steplap
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${CMAKE_INSTALL_INCLUDEDIR}/steplap)
install(DIRECTORY mbd elements transformer DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/steplap
  FILES_MATCHING PATTERN "*.h")
install(TARGETS steplap RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# bin/steplap looks for it at ../libexec, in the build tree as well.
if(TARGET steplap-study)
  install(TARGETS steplap-study RUNTIME DESTINATION libexec)
endif()
install(DIRECTORY models examples DESTINATION ${CMAKE_INSTALL_DATADIR}/steplap)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/steplap)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/steplap)
install(EXPORT steplap NAMESPACE steplap:: FILE steplapTargets.cmake DESTINATION ${package_folder})
configure_package_config_file(cmake/steplapConfig.cmake.in steplapConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(steplapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/steplapConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/steplapConfigVersion.cmake
  DESTINATION ${package_folder})
