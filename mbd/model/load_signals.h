// The kinds of signal that are loads of a transport: a road under an axle, random vibration, a ship in waves.
//
// Laws, limits and sources stand in docs/reference/loads.md.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

/// "road": height of a road by ISO 8608, passed at a constant speed.
[[nodiscard]] const SignalKind& road_kind();
/// "random": a stationary Gaussian vibration within an envelope, by a table of its power spectral density.
[[nodiscard]] const SignalKind& random_kind();
/// "sea": roll or pitch and heave of a vessel, or what a place on it feels of them.
[[nodiscard]] const SignalKind& sea_kind();

} // namespace steplap
