// The kinds of signal that are loads of a transport, or of a test: a road under an axle, random vibration, a ship in waves, a swept sine.
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
/// "chirp": a sine whose frequency runs from one value to another.
[[nodiscard]] const SignalKind& chirp_kind();

} // namespace steplap
