#include "elements/catalog.h"

#include "elements/action.h"
#include "elements/bearing.h"
#include "elements/bushing.h"
#include "elements/contact_group.h"
#include "elements/coulomb_stick.h"
#include "elements/drawn_outline.h"
#include "elements/formula_force.h"
#include "elements/gears.h"
#include "elements/joint_friction.h"
#include "elements/joints.h"
#include "elements/limit.h"
#include "elements/load.h"
#include "elements/machinery/band.h"
#include "elements/machinery/beam.h"
#include "elements/machinery/beam_part.h"
#include "elements/machinery/buffer.h"
#include "elements/machinery/cam.h"
#include "elements/machinery/freewheel.h"
#include "elements/machinery/lossy_gear.h"
#include "elements/machinery/rolling_resistance.h"
#include "elements/machinery/rope.h"
#include "elements/machinery/skate.h"
#include "elements/machinery/tie.h"
#include "elements/machinery/tyre.h"
#include "elements/machinery/wound_rope.h"
#include "elements/maxwell.h"
#include "elements/motor.h"
#include "elements/own_state.h"
#include "elements/polygon_contact.h"
#include "elements/prescribed_motion.h"
#include "elements/round_contacts.h"
#include "elements/shape.h"
#include "elements/spring_damper.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_joint.h"
#include "elements/unilateral_contact.h"
#include "mbd/io/load_case.h"
#include "mbd/io/look.h"
#include "mbd/io/presentation.h"
#include "mbd/io/record_signal.h"
#include "mbd/model/shunting_signal.h"

namespace steplap {

const Catalogue& element_catalog() {
  static const Catalogue catalogue = [] {
    Catalogue c;
    c.elements = {&spring_damper_kind(),
                  &rotational_spring_damper_kind(),
                  &maxwell_kind(),
                  &bushing_kind(),
                  &unilateral_contact_kind(),
                  &circle_contact_kind(),
                  &segment_contact_kind(),
                  &polygon_contact_kind(),
                  &tyre_kind(),
                  &buffer_kind(),
                  &tie_kind(),
                  &beam_part_kind(),
                  &coulomb_stick_kind(),
                  &step_lap_joint_kind(),
                  &step_lap_interface_kind(),
                  &rolling_resistance_kind(),
                  &revolute_kind(),
                  &prismatic_kind(),
                  &weld_kind(),
                  &distance_kind(),
                  &point_on_line_kind(),
                  &prescribed_motion_kind(),
                  &gear_kind(),
                  &rack_kind(),
                  &motor_kind(),
                  &limit_kind(),
                  &joint_friction_kind(),
                  &bearing_kind(),
                  &skate_kind(),
                  &rope_kind(),
                  &wound_rope_kind(),
                  &band_kind(),
                  &belt_kind(),
                  &cam_kind(),
                  &freewheel_kind(),
                  &lossy_gear_kind(),
                  &load_kind(),
                  &formula_force_kind()};
    c.signals = signal_kinds();
    c.signals.push_back(&shunting_kind());
    c.signals.push_back(&record_signal_kind());
    c.tables = {&drawn_outline_kind(), &shape_kind(), &beam_kind(),       &contact_group_kind(), &own_state_kind(), &action_kind(),
                &channel_kind(),       &plot_kind(),  &acceptance_kind(), &case_kind(),          &look_kind()};
    return c;
  }();
  return catalogue;
}

} // namespace steplap
