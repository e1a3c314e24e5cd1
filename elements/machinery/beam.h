// Model table `[[beam]]`: a straight elastic beam, made of rigid segments with elastic parts between them.
//
// The beam of length L is divided into n parts of length h = L/n. Each of the n + 1 nodes carries a rigid segment of length h (h/2 at the
// ends), and in the middle of each part a beam_part (beam_part.h) connects two segments. Small deflections and slopes at the nodes under
// loads at the nodes are exactly those of Euler–Bernoulli theory for any n. A load between nodes acts on the segment there, with an error
// of order h². Each segment has the mass of its part of the beam and the moment of inertia of a straight rod plus that of its cross
// section, m ℓ²/12 + ρ I ℓ; their sums are those of the beam. Natural frequencies are too low by order h²: for a pinned beam by (j π/n)²/24
// in mode j. Large rotations are allowed; bending remains elastic. Compression leads to buckling at Euler's load with an error of order h⁴.
// Damping: each part has dampers of τ times its stiffness; a mode of angular frequency ω has the damping ratio τ ω/2.
#pragma once

#include "mbd/model/body_builder.h"

namespace steplap {

/// One entry of [[beam]]. The beam "deck" has the bodies "deck.0" … "deck.n", the parts "deck.part 1" … "deck.part n", and the end markers
/// "deck.start" and "deck.end", whose x axes point along the beam.
struct Beam : BodyBuilder {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero(); ///< ends of the beam, m
  std::string frame = "ground";                ///< frame of `from` and `to`; inside a part of a file it is the frame of that part
  long segments = 10;                          ///< number n of elastic parts
  std::optional<double> modulus, second_moment, area, density; ///< E, Pa; I, m⁴; A, m²; ρ, kg/m³
  std::optional<double> mass_per_length;                       ///< mass per length, kg/m, including dead load; replaces ρ
  std::string material, profile;                               ///< names such as "steel", "IPE 300"
  std::optional<double> width, height;                         ///< dimensions of a rectangular section, m
  std::optional<double> diameter, wall;                        ///< round section, m: outer diameter, wall thickness
  std::optional<double> shear_stiffness;                       ///< shear stiffness G A_s, N; not given: no shear deformation
  std::optional<double> damping_time;                          ///< damping time τ, s
  std::optional<double> damping_ratio, damping_frequency;      ///< damping ratio at a frequency in Hz, replaces τ

  void add_bodies(Model& model) const override;
};

[[nodiscard]] const TableKind& beam_kind();

} // namespace steplap
