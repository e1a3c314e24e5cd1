// Kinds of signal for transport and test loads: road, random vibration, ship motion, swept sine. Formulas, limits and sources:
// docs/reference/loads.md.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

/// "road": height of a road profile according to ISO 8608 at constant speed.
[[nodiscard]] const SignalKind& road_kind();
/// "random": stationary Gaussian vibration with a given power spectral density, multiplied by an envelope.
[[nodiscard]] const SignalKind& random_kind();
/// "sea": roll or pitch and heave of a vessel, or the acceleration at a point of it.
[[nodiscard]] const SignalKind& sea_kind();
/// "chirp": a sine whose frequency changes from one value to another.
[[nodiscard]] const SignalKind& chirp_kind();

} // namespace steplap
