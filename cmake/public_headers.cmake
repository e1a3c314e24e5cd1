# The public headers. A program on the library includes only <steplap/NAME>. These names and the declarations in their headers remain when
# sources move; all other headers are installed under <steplap/internal/…> because these include them, and may change in any version.
# docs/how-to/use_from_cpp.md has the same table for users.
# install.cmake and tests/architecture/test_public_headers.cpp read this file.

cmake_policy(VERSION 3.25) # of the functions, also when they are read by an installation

# steplap_public_header(NAME "purpose" HEADER ...): <steplap/NAME> includes each HEADER of the source tree.
function(steplap_public_header name purpose)
  set(text "// ${purpose}\n#pragma once\n")
  foreach(header ${ARGN})
    string(APPEND text "#include <steplap/internal/${header}>\n")
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/include/steplap/${name} CONTENT "${text}" @ONLY)
  set_property(GLOBAL APPEND PROPERTY STEPLAP_PUBLIC_HEADERS ${CMAKE_CURRENT_BINARY_DIR}/include/steplap/${name})
  set_property(GLOBAL APPEND PROPERTY STEPLAP_PUBLIC_SOURCES ${ARGN})
endfunction()

# Sets OUT to the given headers and all headers of the folder SOURCE that they include, directly or through others.
function(steplap_included_headers out source)
  set(found)
  set(open ${ARGN})
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${source}/${header} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
      if(NOT included MATCHES "/") # a header of the same folder
        cmake_path(GET header PARENT_PATH folder)
        set(included ${folder}/${included})
      endif()
      list(APPEND open ${included})
    endforeach()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()

if(STEPLAP_FUNCTIONS_ONLY) # while headers are installed
  return()
endif()

steplap_public_header(model.h "Models as values: bodies, markers, signals, elements by name; made in C++ or changed by path. Errors of models."
  mbd/base/diagnostics.h mbd/base/types.h mbd/model/model.h mbd/model/model_building.h mbd/model/model_path.h mbd/model/completion.h)
steplap_public_header(elements.h "The kinds of elements and tables that a model may have, each with the struct that holds its fields."
  elements/action.h elements/bushing.h elements/coulomb_stick.h elements/formula_force.h elements/gears.h elements/joint_friction.h
  elements/joints.h elements/limit.h elements/load.h elements/motor.h elements/own_state.h elements/polygon_contact.h
  elements/prescribed_motion.h elements/round_contacts.h elements/shape.h elements/spring_damper.h elements/unilateral_contact.h
  elements/machinery/band.h elements/machinery/beam.h elements/machinery/beam_part.h elements/machinery/buffer.h
  elements/machinery/cam.h elements/machinery/freewheel.h elements/machinery/lossy_gear.h elements/machinery/rolling_resistance.h
  elements/machinery/rope.h elements/machinery/skate.h elements/machinery/tie.h elements/machinery/tyre.h
  elements/machinery/wound_rope.h elements/step_lap/step_lap_interface.h elements/step_lap/step_lap_joint.h
  transformer/core/clamp.h transformer/core/core.h transformer/core/uncertain.h transformer/recorder/recorder.h)
steplap_public_header(catalog.h "Lists of kinds: what a model file may use."
  elements/catalog.h transformer/catalog.h transformer/program.h)
steplap_public_header(model_file.h "Models from TOML files."
  mbd/io/reader.h)
steplap_public_header(system.h "Compiled systems: one from a model, or many from the same model with other values."
  mbd/system/system.h mbd/system/instance.h)
steplap_public_header(simulate.h "Where a run begins, the run itself, its events, samples and extremes."
  mbd/rest/start.h mbd/simulation/simulation.h)
steplap_public_header(rest.h "Poses at rest, and small vibrations about them."
  mbd/rest/equilibrium.h mbd/rest/modes.h)
steplap_public_header(accuracy.h "Estimated errors of a run, by finer runs."
  mbd/trust/global_error.h)
steplap_public_header(verdict.h "Criteria and the verdict on a run."
  mbd/trust/criteria.h mbd/trust/element_judgement.h mbd/trust/judge.h mbd/trust/judgement.h)
steplap_public_header(judged_run.h "A model from its file to a judged result, with its files, as the command line makes them."
  mbd/base/stop.h mbd/run/estimate.h mbd/run/failure.h mbd/run/finding.h mbd/run/loaded_model.h mbd/run/overview.h mbd/run/report.h
  mbd/run/results.h mbd/run/run.h mbd/run/run_options.h mbd/run/second_opinion.h mbd/run/version.h mbd/run/with_settings.h
  transformer/program.h)
steplap_public_header(own_element.h "What a kind of element of your own is made of: laws, measures, roles."
  mbd/system/law_group.h mbd/system/measure.h mbd/system/roles.h mbd/trust/element_judgement.h)
