// The conformance suite's scenes: two bodies a and b and one element of each kind between them, with
// typical values. A new kind needs one entry here and gets the whole suite.
#pragma once

#include <string>
#include <vector>

namespace steplap::testing {

struct ConformanceScene {
  const char* kind;
  /// TOML of the element (and of what it needs). Numbers written @+1.0 or @-1.0 change sign when the
  /// scene is mirrored in x: x of points and axes, angles, couples.
  const char* text;
  bool is_external = false;   ///< acts on one body only, or in fixed axes: no third law, no invariance
  bool is_reversible = false; ///< its measure treats a and b alike: swapping them changes no force
};

// Markers off the centres of gravity with turned axes, so that every lever arm and every turn shows.
inline const char* k_conformance_bodies = R"(
gravity = [0.0, 0.0]
[simulation]
step = 1e-3
[[body]]
name = "a"
mass = 2.0
inertia = 0.5
position = [@+0.3, 0.4]
angle = @+0.2
[[body]]
name = "b"
mass = 3.0
inertia = 0.8
position = [@-0.2, -0.5]
angle = @-0.1
[[marker]]
name = "on a"
body = "a"
point = [@+0.15, -0.2]
angle = @+0.3
[[marker]]
name = "on b"
body = "b"
point = [@-0.1, 0.25]
angle = @-0.15
[[signal]]
name = "wave"
kind = "harmonics"
offset = 1.5
amplitudes = [0.5]
frequencies = [2.0]
[[element]]
name = "tested"
)";

/// Springs, dampers and bushings.
inline std::vector<ConformanceScene> spring_scenes() {
  return {
      {"spring_damper", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\nfree_length = 0.3\n", false, true},
      {"spring_damper",
       "a = \"A\"\nb = \"B\"\nforce_table = [[-0.5, -700.0], [0.0, 0.0], [0.3, 100.0], [0.8, 900.0]]\nbetween = \"curve\"\n"
       "damping_table = [[-2.0, -50.0], [0.0, 0.0], [2.0, 90.0]]\nfree_length = 0.3\n",
       false, true},
      {"spring_damper", "a = \"A\"\nb = \"B\"\naxis = [@+0.6, 0.8]\nstiffness = 800.0\ndamping = 30.0\npreload = 20.0\n"},
      {"spring_damper", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\ngap = 0.06\n", false, true},
      {"spring_damper", "a = \"A\"\nb = \"B\"\nacross = 0.7\nstiffness = 800.0\ndamping = 30.0\npreload = -20.0\ncount = 2\n", false, true},
      {"spring_damper",
       "a = \"A\"\nb = \"B\"\nforce_table = [[-0.1, -90.0], [-0.02, -10.0], [0.03, 20.0], [0.1, 120.0]]\n"
       "damping_table = [[-1.0, -40.0], [0.0, 0.0], [1.0, 15.0]]\ncount = 2\n",
       false, true},
      {"rotational_spring_damper", "a = \"A\"\nb = \"B\"\nstiffness = 70.0\ndamping = 3.0\nfree_angle = @+0.1\n", false, false},
      {"rotational_spring_damper", "a = \"A\"\nb = \"B\"\nstiffness = 70.0\ndamping = 3.0\ngap = 0.2\nfree_angle = @+0.1\n", false, false},
      {"maxwell", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\n", false, true},
      {"maxwell", "a = \"A\"\nb = \"B\"\naxis = [@+0.6, 0.8]\nstiffness = 800.0\ndamping = 30.0\ncount = 2\n"},
      {"maxwell", "a = \"A\"\nb = \"B\"\nacross = 0.7\nstiffness = 800.0\ndamping = 30.0\n", false, true},
      {"bushing", "a = \"A\"\nb = \"B\"\nstiffness = [500.0, 900.0]\ndamping = [20.0, 30.0]\nrotational_stiffness = 60.0\n"
                  "rotational_damping = 2.0\n"}};
}

/// Contacts, closed in this pose.
inline std::vector<ConformanceScene> contact_scenes() {
  return {
      {"unilateral_contact", "a = \"A\"\nb = \"B\"\nnormal = [@+0.1, 1.0]\nstiffness = 900.0\ndamping = 25.0\ngap = 0.02\n"},
      {"unilateral_contact",
       "a = \"A\"\nb = \"B\"\naxis = [@-0.2, 1.0]\nstiffness = 900.0\ndamping = 25.0\ninterference = 0.02\ncount = 2\n"},
      {"unilateral_contact",
       "a = \"A\"\nb = \"B\"\naxis = [@+0.1, 1.0]\nlaw = \"literal\"\nstiffness = 900.0\ndamping = 25.0\npreload = 10.0\n"},
      {"unilateral_contact",
       "a = \"A\"\nb = \"B\"\nlaw = \"hunt_crossley\"\nexponent = 1.5\ndissipation = 0.6\nstiffness = 9000.0\npreload = 15.0\n"},
      {"unilateral_contact", // on a face with ends, past which its poses reach
       "a = \"A\"\nb = \"B\"\nstiffness = 900.0\ndamping = 25.0\ninterference = 0.02\nends = [-0.64, 0.64]\n"},
      {"circle_contact", "a = \"A\"\nb = \"B\"\nradius_a = 0.3\nradius_b = 0.58\nstiffness = 900.0\ndamping = 25.0\n"},
      {"circle_contact", "a = \"A\"\nb = \"B\"\nradius_a = 0.05\nradius_b = 0.9\ninside = true\nlaw = \"hunt_crossley\"\nexponent = 1.5\n"
                         "dissipation = 0.6\nstiffness = 9000.0\n"},
      {"segment_contact",
       "a = \"A\"\nb = \"B\"\nradius = 0.37\nfrom = [@+0.2, 0.25]\nto = [@+1.1, 0.3]\nthickness = 0.02\nstiffness = 900.0\n"
       "damping = 25.0\n"},
      {"segment_contact", // on the end
       "a = \"A\"\nb = \"B\"\nradius = 0.38\nfrom = [@-0.6, 0.2]\nto = [@+0.45, 0.3]\nthickness = 0.02\nstiffness = 900.0\n"
       "damping = 25.0\n"},
      // Flat, and gripping whatever it takes; on a hump that is its own mirror image, and sliding at times.
      {"tyre", "a = \"A\"\nb = \"B\"\nradius = 0.66\nstiffness = 900.0\ndamping = 25.0\nfriction = 20.0\nslip_stiffness = 20.0\n"
               "relaxation_length = 0.2\ntread_damping = 2.0\n"},
      {"tyre",
       "a = \"A\"\nb = \"B\"\nradius = 0.6\nroad = [[-1.2, 0.0], [-0.6, 0.05], [0.0, 0.12], [0.6, 0.05], [1.2, 0.0]]\nstiffness = 900.0\n"
       "damping = 25.0\nfriction = 0.3\nslip_stiffness = 20.0\nrelaxation_length = 0.2\ntread_damping = 2.0\n"},
      {"polygon_contact", // a corner on a face
       "a = \"A\"\nb = \"B\"\nstiffness = 900.0\ndissipation = 0.6\n"
       "outline_a = [[@-0.2, -0.2], [@+0.2, -0.2], [@+0.2, 0.2], [@-0.2, 0.2]]\n"
       "outline_b = [[@-1.0, -0.5], [@+1.2, -0.5], [@+1.2, 0.37], [@-1.0, 0.37]]\n"},
      {"polygon_contact", // a corner on a corner
       "a = \"A\"\nb = \"B\"\nstiffness = 9000.0\n"
       "outline_a = [[@-0.2, -0.2], [@+0.2, -0.2], [@+0.2, 0.2], [@-0.2, 0.2]]\n"
       "outline_b = [[@-0.5, 0.0], [@+0.2, -0.6], [@+0.62, 0.38]]\n"},
      {"polygon_contact", // a face on a face, where that ends
       "a = \"A\"\nb = \"B\"\nstiffness = 900.0\ndissipation = 0.6\n"
       "outline_a = [[@-0.2790, 0.0463], [@-0.0463, -0.2790], [@+0.2790, -0.0463], [@+0.0463, 0.2790]]\n"
       "outline_b = [[@-1.0, -0.5], [@+0.7, -0.5], [@+0.7, 0.42], [@-1.0, 0.42]]\n"},
      {"polygon_contact", // on a half-plane
       "a = \"A\"\nb = \"B\"\nnormal = [@+0.1, 1.0]\nstiffness = 900.0\ndissipation = 0.6\n"
       "static_friction = 0.4\nkinetic_friction = 0.3\n"
       "outline_a = [[@-0.2, -0.83], [@+0.2, -0.83], [@+0.2, 0.2], [@-0.2, 0.2]]\n"},
      {"polygon_contact", "a = \"A\"\nb = \"B\"\nstiffness = 900.0\ndissipation = 0.6\nstatic_friction = 0.4\nkinetic_friction = 0.3\n"
                          "outline_a = [[@-1.2, -0.2], [@+0.5, -0.2], [@+0.2, 0.2]]\n"
                          "outline_b = [[@+0.4, -0.3], [@+0.9, -0.3], [@+0.62, 0.378]]\n"}};
}

/// Friction, dry and of overlapped sheets.
inline std::vector<ConformanceScene> friction_scenes() {
  return {{"coulomb_stick",
           "contacts = [\"roller\"]\nstatic_friction = 0.4\nkinetic_friction = 0.3\n"
           "[[element]]\nkind = \"circle_contact\"\nname = \"roller\"\na = \"A\"\nb = \"B\"\nradius_a = 0.3\nradius_b = 0.58\n"
           "stiffness = 900.0\ndamping = 25.0\n"},
          {"coulomb_stick",
           "contacts = [\"roller\"]\nstatic_friction = 0.4\nkinetic_friction = 0.3\n"
           "[[element]]\nkind = \"segment_contact\"\nname = \"roller\"\na = \"A\"\nb = \"B\"\nradius = 0.37\nfrom = [@+0.2, 0.25]\n"
           "to = [@+1.1, 0.3]\nthickness = 0.02\nstiffness = 900.0\ndamping = 25.0\n"},
          {"coulomb_stick",
           "contacts = [\"rear\", \"front\"]\nstatic_friction = 0.4\nkinetic_friction = 0.3\n"
           "[[element]]\nkind = \"unilateral_contact\"\nname = \"rear\"\na = \"A\"\nb = \"B\"\naxis = [@+0.1, 1.0]\n"
           "stiffness = 900.0\ndamping = 25.0\npreload = 40.0\n"
           "[[element]]\nkind = \"unilateral_contact\"\nname = \"front\"\na = { body = \"a\", point = [@+0.4, -0.3], angle = @+0.3 }\n"
           "b = \"B\"\naxis = [@+0.1, 1.0]\nstiffness = 900.0\ndamping = 25.0\npreload = 60.0\n"},
          {"rolling_resistance",
           "contacts = [\"roller\"]\narm = 0.02\n"
           "[[element]]\nkind = \"circle_contact\"\nname = \"roller\"\na = \"A\"\nb = \"B\"\nradius_a = 0.3\nradius_b = 0.58\n"
           "stiffness = 900.0\ndamping = 25.0\n"},
          {"rolling_resistance",
           "contacts = [\"wheel\"]\narm = 0.02\n"
           "[[element]]\nkind = \"tyre\"\nname = \"wheel\"\na = \"A\"\nb = \"B\"\nradius = 0.66\nstiffness = 900.0\ndamping = 25.0\n"
           "friction = 0.8\nslip_stiffness = 20.0\nrelaxation_length = 0.2\ntread_damping = 2.0\n"},
          {"step_lap_joint", "limb = \"a\"\nactive_part = \"b\"\n"},
          {"step_lap_interface", "joint = \"joint\"\nframe = \"body\"\nyoke = [[@-0.5, 0.3], [@+0.6, 0.3], [@+0.6, 0.9], [@-0.5, 0.9]]\n"
                                 "limb = [[@-0.4, -0.6], [@+0.3, -0.6], [@+0.3, 0.2], [@-0.4, 0.2]]\npressure = 1000.0\n"
                                 "static_friction = 0.3\ncount = 10.0\n"
                                 "[[element]]\nkind = \"step_lap_joint\"\nname = \"joint\"\nlimb = \"a\"\nactive_part = \"b\"\n"},
          // Elastic, within its bound, with edges that bear.
          {"step_lap_joint", "limb = \"a\"\nactive_part = \"b\"\ntangential_stiffness = 700.0\nedge_stiffness = 900.0\n"
                             "[[element]]\nkind = \"step_lap_interface\"\nname = \"sheets\"\njoint = \"tested\"\nframe = \"body\"\n"
                             "yoke = [[@-0.5, 0.3], [@+0.6, 0.3], [@+0.6, 0.9], [@-0.5, 0.9]]\n"
                             "limb = [[@-0.4, -0.6], [@+0.3, -0.6], [@+0.3, 0.2], [@-0.4, 0.2]]\npressure = 1e9\n"
                             "static_friction = 0.3\nclearance = 0.01\n"}};
}

/// Wound ropes, ties and buffers.
inline std::vector<ConformanceScene> rope_scenes() {
  return {
      {"buffer", "a = \"A\"\nb = \"B\"\naxis = [@+0.6, 0.8]\nloading = [[0.0, 0.0], [1.0, 900.0]]\nunloading = [[0.0, 0.0], [2.0, 600.0]]\n"
                 "gap = -0.05\n"},
      {"wound_rope", "a = \"A\"\nb = \"B\"\nradius_a = @+0.12\nradius_b = @-0.2\nstiffness = 800.0\ndamping = 30.0\npretension = 9.0\n"},
      {"wound_rope", // crossed
       "a = \"A\"\nb = \"B\"\nradius_a = @+0.1\nradius_b = @+0.1\nstiffness = 800.0\ndamping = 30.0\nslack = 0.01\n", false, true},
      {"wound_rope", "a = \"A\"\nb = \"B\"\nradius_a = @-0.15\nstiffness = 800.0\n"},
      {"tie", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\nslack = 0.01\n", false, true},
      {"tie", "a = \"A\"\nb = \"B\"\nacross = 0.7\nstiffness = 800.0\ndamping = 30.0\npreload = 9.0\nacts = \"both\"\n", false, true},
      {"tie", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\npreload = 9.0\nacts = \"both\"\nstrength = 1e6\n", false, true},
      {"tie", "a = \"A\"\nb = \"B\"\naxis = [@+0.6, 0.8]\nstiffness = 800.0\ndamping = 30.0\nslack = 0.01\nacts = \"both\"\ncount = 2\n"}};
}

/// Joints, drives, ropes over points, and loads.
inline std::vector<ConformanceScene> joint_scenes() {
  return {
      {"revolute", "a = \"A\"\nb = \"B\"\n"},
      {"prismatic", "a = \"A\"\nb = \"B\"\naxis = [@+0.8, 0.6]\n"},
      {"weld", "a = \"A\"\nb = \"B\"\n"},
      {"distance", "a = \"A\"\nb = \"B\"\nlength = 0.6\n", false, true},
      {"point_on_line", "a = \"A\"\nb = \"B\"\naxis = [@+0.8, 0.6]\n"},
      {"prescribed_motion", "a = \"A\"\nb = \"B\"\ncoordinate = \"y\"\nsignal = \"wave\"\nas = \"velocity\"\n"},
      {"prescribed_motion", "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nsignal = \"wave\"\n", false, true},
      {"gear", "a = \"A\"\nb = \"B\"\nradius_a = 0.3\nradius_b = 0.5973468189472534\n"},
      {"rack", "a = \"A\"\nb = \"B\"\nradius = 0.3\naxis = [0.8, @+0.6]\n"}, // the pinion stays on the left
      {"motor", "a = \"A\"\nb = \"B\"\ncoordinate = \"y\"\neffort = \"wave\"\nno_load_speed = 3.0\ntarget = \"wave\"\nproportional = 50.0\n"
                "derivative = 4.0\n"},
      {"motor", "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nconstant_effort = 7.0\nno_load_speed = 3.0\n", false, true},
      {"limit", "a = \"A\"\nb = \"B\"\ncoordinate = \"y\"\nlower = -0.03\nupper = 0.02\nstiffness = 900.0\ndamping = 25.0\n"},
      {"limit", "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nlower = 0.8\nupper = 0.87\nstiffness = 900.0\ndamping = 25.0\n", false,
       true},
      {"bearing", "a = \"A\"\nb = \"B\"\nstiffness = 900.0\ndamping = 25.0\nradius = 1.0\nstatic_friction = 0.4\nkinetic_friction = 0.3\n"},
      {"joint_friction", "a = \"A\"\nb = \"B\"\ncoordinate = \"angle\"\nholds = 3.0\ndrags = 2.0\n"},
      {"joint_friction", "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nholds = 30.0\n", false, true},
      {"skate", "a = \"A\"\nb = \"B\"\naxis = [@+0.8, 0.6]\n"},
      {"skate", "a = \"A\"\nb = \"B\"\naxis = [@+0.8, 0.6]\ngrip = 30.0\ndrags = 20.0\n"},
      {"rope", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\nslack = 0.02\n", false, true},
      {"rope", "a = \"A\"\nb = \"B\"\nstiffness = 800.0\ndamping = 30.0\npretension = 9.0\nacross = 0.7\ncount = 2\n", false, true},
      {"rope",
       "a = \"A\"\nb = \"B\"\nover = [\"high on b\", \"low on a\", \"low on a\"]\nstiffness = 800.0\ndamping = 30.0\npretension = 9.0\n"
       "[[marker]]\nname = \"high on b\"\nbody = \"b\"\npoint = [@+0.2, 0.6]\n"
       "[[marker]]\nname = \"low on a\"\nbody = \"a\"\npoint = [@-0.3, 0.1]\n"},
      {"load", "at = \"A\"\nforce = [@+5.0, 3.0]\ncouple = @+0.7\nforce_y = \"wave\"\n", true},
      {"load", "at = \"A\"\nforce = [@+5.0, 3.0]\ncouple = @-0.7\nforce_y = \"wave\"\nframe = \"body\"\n", true}};
}

/// Bands, belts, cams, one-way clutches, gears with losses, parts of beams.
inline std::vector<ConformanceScene> drive_scenes() {
  return {{"beam_part", "a = \"A\"\nb = \"B\"\naxis = [@+0.9, 0.2]\nlength = 0.9\naxial_stiffness = 300.0\nbending_stiffness = "
                        "20.0\nshear_stiffness = 90.0\ndamping_time = 0.02\n"},
          {"band",
           "a = \"A\"\nb = { body = \"ground\", at = [@-1.4, 0.6] }\ndrum = \"B\"\nradius = @+0.2\nfriction = 0.5\nstiffness = "
           "800.0\nstiffness_b = 500.0\ndamping = 30.0\n"
           "pretension = 900.0\n",
           true}, // sticks, as its energy is that of a spring
          {"belt", "a = \"A\"\nb = \"B\"\nradius_a = 0.12\nradius_b = 0.2\nfriction_a = 0.7\nfriction_b = 0.6\nstiffness = 800.0\ndamping "
                   "= 30.0\npretension = 900.0\n"},
          {"belt", "a = \"A\"\nb = \"B\"\nradius_a = 0.12\nradius_b = 0.2\ncrossed = true\nfriction_a = 0.7\nfriction_b = 0.6\nstiffness = "
                   "800.0\ndamping = 30.0\npretension = 900.0\n"},
          {"cam",
           "a = \"A\"\nb = { body = \"ground\", angle = @+0.2 }\ncam = \"b\"\naxis = [@+0.1, 1.0]\nformula = \"'40 mm' * (1 - cos(value)) "
           "+ '10 mm' * cos(2 * value)\"\n"
           "start_angle = @+0.4\ngap = -0.05\nstiffness = 900.0\ndamping = 5.0\n",
           true},
          {"freewheel", "a = \"A\"\nb = \"B\"\ndrags = 2.0\nholds = 5.0\n"},
          {"lossy_gear", "a = \"A\"\nb = \"B\"\nratio = -2.5\nefficiency = 0.8\nstiffness = 90.0\ndamping = 3.0\n", true}};
}

/// Forces by formula: along every coordinate, of kinks and jumps, of motions of other bodies.
inline std::vector<ConformanceScene> formula_scenes() {
  return {{"force", "a = \"A\"\nb = \"B\"\ncoordinate = \"y\"\nformula = \"'90 N/m' * value - '3 N s2/m2' * abs(rate) * rate\"\n"},
          {"force", "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nformula = \"-'9 N m2' / value^2 - min('40 N s/m' * rate, '8 N')\"\n",
           false, true},
          {"force", "a = \"A\"\nb = \"B\"\ncoordinate = \"angle\"\nformula = \"'7 N m' * sin(3 * value) - '2 N m s' * rate\"\n"},
          {"force", "a = \"A\"\nb = \"B\"\ncoordinate = \"own_y\"\nformula = \"'5 N' - '4 N s/m' * rate\"\n"},
          {"force",
           "a = \"A\"\nb = \"B\"\ncoordinate = \"distance\"\nenergy = \"dissipated\"\n"
           "formula = \"value > '0.8 m' ? -'6 N s/m' * rate : -'2 N s/m' * rate\"\n",
           false, true},
          {"force",
           "a = \"A\"\nb = \"B\"\ncoordinate = \"y\"\nformula = \"'3 N/m' * a.y + '2 N' * cos(b.theta) * exp(a.vy / '1 m/s') - '4 N s/m' * "
           "hypot(b.vx, b.vy)\"\n",
           true}};
}

inline const std::vector<ConformanceScene>& conformance_scenes() {
  static const std::vector<ConformanceScene> list = [] {
    std::vector<ConformanceScene> all;
    for (const auto& part :
         {spring_scenes(), contact_scenes(), friction_scenes(), rope_scenes(), joint_scenes(), drive_scenes(), formula_scenes()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return list;
}

} // namespace steplap::testing
