// Channels made only on request of the model, in addition to those of elements: motion of markers, energies of the whole system and of
// single elements, slides, formulas (formula_channel.h).
//
//   M.x .y .vx .vy .ax .ay        marker M, ground axes; accelerations from the equations of motion
//   whole.kinetic .potential .dissipated .work .balance
//   E.dissipated .stored .work    of element E, since the start
//   E.slide                       of element E, friction whose contact point changes, since the start
#pragma once

#include "mbd/formula/formula.h"
#include "mbd/system/system.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// Compiles the channels that a model requests: formulas, and energies and slides of single elements.
class RequestedChannels {
public:
  /// Parses the formulas. Errors are reported to the builder.
  explicit RequestedChannels(SystemBuilder& builder);

  /// Called before and after an element is compiled, to determine which parts of the system belong to the element.
  void begin_element();
  void end_element();
  /// Replaces end_element() for an inactive element, whose energies are constant. `acting` is the system being compiled.
  void end_inactive_element(System& acting);
  /// Adds the requested channels. Precondition: all elements are compiled.
  void add();

  /// Returns the channel with this name among those of the elements compiled so far; nullptr if there is none.
  [[nodiscard]] static const Channel* made_channel(const SystemBuilder& builder, const std::string& name);
  /// Returns the names of the channels that are measures (measured_channel.h), which formulas in the equations of motion may use.
  [[nodiscard]] static std::vector<std::string> measured_names(const SystemBuilder& builder);

private:
  struct Defined {
    const DefinedChannel* definition;
    std::optional<Formula> expression;
    enum class Mark { untouched, open, done } mark = Mark::untouched;
  };
  struct Share { ///< parts of the system that belong to one element
    int element = 0;
    std::vector<const ForceGroup*> groups;
    std::vector<std::size_t> first, count;
    std::vector<char> does_work;
    std::size_t first_row = 0, row_end = 0, first_friction = 0, friction_end = 0;
    bool dissipates = false, stores = false, works = false; ///< energy channels requested
    bool acts = true;
  };

  void note(const Location& where, const std::string& message);
  Channel* make(bool is_on_request, std::string_view owner, std::string_view name, std::string_view unit, const ChannelText& text,
                std::function<double(const Snapshot&)> value);
  void note_operands_of_elements();
  void add_markers();
  void add_whole();
  void add_share(const Share& share);
  void add_inactive_share(const Share& share);
  void add_integral(const Share& share, const char* name, const char* unit, const ChannelText& text, Integrand integrand);
  void add_slide(const Share& share);
  void add_formulas();
  void add_formula(Defined& formula, int depth = 0);
  [[nodiscard]] const Channel& operand(const DefinedChannel& definition, const std::string& name) const;
  [[nodiscard]] static std::pair<std::string, double> unit_of(const DefinedChannel& definition, const UnitDimension& derived);
  [[nodiscard]] bool is_anything_missing() const;
  [[noreturn]] void refuse_as_too_large(const DefinedChannel& definition, const std::string& what);
  [[nodiscard]] const Channel* find(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> all_names() const;
  void check_names();
  void check_patterns();

  SystemBuilder& builder_;
  const Model& model_;
  std::vector<Defined> formulas_;
  std::vector<Share> shares_;
  std::vector<std::size_t> counts_; ///< number of entries in each group before the current element was compiled
  std::size_t rows_ = 0, frictions_ = 0;
  bool has_requests_;          ///< the model requests channels
  bool wants_shares_;          ///< energies of single elements may be requested
  std::size_t operations_ = 0; ///< number of operations of all formulas; a formula includes those of the formulas that it uses
  bool is_beyond_limits_ = false;
};

/// Compiles a completed model with all channels that it could request. Throws ModelError, also for names that are ambiguous only then.
[[nodiscard]] std::unique_ptr<System> compile_with_all_channels(Model model);

} // namespace steplap
