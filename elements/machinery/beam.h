// `[[beam]]`: a straight elastic beam in the plane, made of rigid segments with elastic parts between them.
//
// n parts of length h = L/n. At the n + 1 places between and at the ends of the parts stands a rigid segment, h long, at the ends h/2,
// and in the middle of each part a beam_part (beam_part.h) joins two of them. So deflections and slopes under loads at the segments' places are
// those of the elastic line, exactly, for any n, as far as these are small; loads in between count as on the segment under them, with an
// error of the order h². Each segment has the mass of its part of the beam and the moment of inertia of a straight rod and of its cross section,
// m ℓ²/12 + ρ I ℓ: both add up to the beam's. Frequencies come out too low by the order h²: of a pinned beam by (j π/n)²/24 of the j-th.
// Large turns are followed; what bends stays elastic. A force of compression buckles it, at Euler's load with an error of the order h⁴.
// Damping: each part has dampers of τ times its stiffness; a mode of angular frequency ω is damped by the ratio τ ω/2.
#pragma once

#include "mbd/model/body_builder.h"

namespace steplap {

/// One entry of [[beam]]. Its bodies are called "deck.0" … "deck.n", its parts "deck.part 1" … "deck.part n" and its end markers, whose
/// x axes point along the beam, "deck.start" and "deck.end".
struct Beam : BodyBuilder {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();                 ///< m
  std::string frame = "ground";                                ///< axes of from and to: in a part those of the part
  long segments = 10;                                          ///< n
  std::optional<double> modulus, second_moment, area, density; ///< E, I, A, ρ
  std::optional<double> mass_per_length;                       ///< kg/m, with what lies on the beam; instead of ρ
  std::string material, profile;                               ///< "steel", "IPE 300"
  std::optional<double> width, height;                         ///< m, of a rectangular section
  std::optional<double> diameter, wall;                        ///< m, of a round one: the outer diameter
  std::optional<double> shear_stiffness;                       ///< G A_s, N; not given: it does not shear
  std::optional<double> damping_time;                          ///< τ, s
  std::optional<double> damping_ratio, damping_frequency;      ///< at a frequency in Hz

  void add_bodies(Model& model) const override;
};

[[nodiscard]] const TableKind& beam_kind();

} // namespace steplap
