// List of the kinds of events, and the text for each.
//
// Code compares kinds. Texts are made when an event is written (events.csv, screen, pages), and parsed when they are read (criteria of a
// model, result files).
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

enum class EventKind : std::uint8_t {
  none, ///< change of mode that is not reported as an event
  opens,
  closes,
  force_reaches_zero,
  force_returns,
  reaches_lower_stop,
  reaches_upper_stop,
  leaves_stop,
  enters_gap,
  closes_gap,
  passes_kink,
  slips,
  slips_forward,
  slips_backward,
  changes_slip_direction,
  sticks,
  loses_normal_force,
  changes_foot,
  loses_interface,
  meets_interface,
  storm,
  event_storm_ends,
  happens,
  breaks,
  comes_apart ///< last; add new kinds before it
};

inline constexpr std::size_t k_event_kinds = static_cast<std::size_t>(EventKind::comes_apart) + 1;

/// Returns the text of a kind, such as "slips forward"; "" for `none`.
[[nodiscard]] const char* words_of(EventKind kind);
/// Returns one line that explains what has happened.
[[nodiscard]] const char* doc_of(EventKind kind);

/// Returns the kind whose text is exactly `words`, or nothing.
[[nodiscard]] std::optional<EventKind> event_kind_called(std::string_view words);
/// Returns the kind at the beginning of `entry`; a detail such as "for 2 ms" may follow the text. Nothing if no kind fits.
[[nodiscard]] std::optional<EventKind> event_kind_of_entry(std::string_view entry);
/// Set of kinds, one bit each.
using EventKinds = std::bitset<k_event_kinds>;
/// Returns the kinds whose text matches a pattern with * and ?.
[[nodiscard]] EventKinds event_kinds_matching(const std::string& pattern);

/// Returns true if friction starts to slip or the slip changes direction.
[[nodiscard]] constexpr bool is_slip(EventKind kind) {
  return kind == EventKind::slips || kind == EventKind::slips_forward || kind == EventKind::slips_backward ||
         kind == EventKind::changes_slip_direction;
}

/// Returns true for a kink of a force law. The force is continuous there.
[[nodiscard]] constexpr bool is_kink(EventKind kind) { return kind == EventKind::passes_kink; }

/// Returns true for events that are listed first: slip, stick, lift-off, touch-down and the like. The others (a change of contact foot, a
/// kink of a contact force) matter only to the integrator.
[[nodiscard]] constexpr bool is_main(EventKind kind) {
  return kind != EventKind::changes_foot && kind != EventKind::force_reaches_zero && kind != EventKind::force_returns;
}

} // namespace steplap
