// What an event is: the one list of kinds, and the words that people read for each.
//
// Code compares kinds. Words are made where an event is written (events.csv, the screen, a page) and read where a person
// wrote them: in the criteria of a model, in the files of results.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steplap {

enum class EventKind : std::uint8_t {
  none, ///< a change that is no event
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
  slips_another_way,
  sticks,
  loses_normal_force,
  changes_foot,
  loses_interface,
  meets_interface,
  storm,
  storm_over,
  happens,
  breaks,
  comes_apart ///< the last one: new kinds go before it
};

inline constexpr std::size_t k_event_kinds = static_cast<std::size_t>(EventKind::comes_apart) + 1;

/// "slips forward"; nothing for `none`.
[[nodiscard]] const char* words_of(EventKind kind);
/// What has happened, in a line.
[[nodiscard]] const char* doc_of(EventKind kind);

/// The kind that is written with these words, if there is one.
[[nodiscard]] std::optional<EventKind> event_kind_called(std::string_view words);
/// The same of a whole entry, in which a detail may follow the words ("… time stepping" "for 2 ms").
[[nodiscard]] std::optional<EventKind> event_kind_of_entry(std::string_view entry);
/// Those whose words match a pattern with * and ?, a bit for each kind.
using EventKinds = std::bitset<k_event_kinds>;
[[nodiscard]] EventKinds event_kinds_matching(const std::string& pattern);

/// Friction begins to slide, or turns to slide another way.
[[nodiscard]] constexpr bool is_slip(EventKind kind) {
  return kind == EventKind::slips || kind == EventKind::slips_forward || kind == EventKind::slips_backward ||
         kind == EventKind::slips_another_way;
}

/// Of a characteristic: no force jumps.
[[nodiscard]] constexpr bool is_kink(EventKind kind) { return kind == EventKind::passes_kink; }

/// Slips, sticks, lift-offs and touch-downs: what a reader looks for first. The rest (a change of the last contact foot,
/// a kink of a contact's force) matters to the integrator.
[[nodiscard]] constexpr bool is_main(EventKind kind) {
  return kind != EventKind::changes_foot && kind != EventKind::force_reaches_zero && kind != EventKind::force_returns;
}

} // namespace steplap
