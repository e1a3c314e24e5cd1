// Channels that a model asks for, made beside those that elements make: motion of markers, energies of the whole and of single
// elements, formulas (formula_channel.h). What nobody asks for is not made.
//
//   M.x .y .vx .vy .ax .ay        of marker M, ground axes; accelerations as the equations of motion give them
//   whole.kinetic .potential .dissipated .work .balance
//   E.dissipated .stored .work    of element E, since the start
#pragma once

#include "mbd/formula/formula.h"
#include "mbd/system/system.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

class RequestedChannels {
public:
  /// Reads the formulas; what is wrong with them goes to the builder's errors.
  explicit RequestedChannels(SystemBuilder& builder);

  /// Around an element's compilation: what of the system is its share.
  void begin_element();
  void end_element();
  /// The same of one that does not act: its energies stay as they are, so that they have their places. `acting`: the system being made.
  void end_inactive_element(System& acting);
  /// When the system is complete but for these.
  void add();

  /// A channel that elements before this one have made, or nullptr.
  [[nodiscard]] static const Channel* made_channel(const SystemBuilder& builder, const std::string& name);
  /// Names of those that are measures (measured_channel.h).
  [[nodiscard]] static std::vector<std::string> measured_names(const SystemBuilder& builder);

private:
  struct Defined {
    const DefinedChannel* definition;
    std::optional<Formula> expression;
    enum class Mark { untouched, open, done } mark = Mark::untouched;
  };
  struct Share { ///< of an element
    int element = 0;
    std::vector<const ForceGroup*> groups;
    std::vector<std::size_t> first, count;
    std::vector<char> does_work;
    std::size_t first_row = 0, row_end = 0, first_friction = 0, friction_end = 0;
    bool dissipates = false, stores = false, works = false; ///< its channels
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
  void add_energy(const Share& share, const char* name, const ChannelText& text, Integrand integrand);
  void add_formulas();
  void add_formula(Defined& formula);
  [[nodiscard]] const Channel& operand(const DefinedChannel& definition, const std::string& name) const;
  [[nodiscard]] static std::pair<std::string, double> unit_of(const DefinedChannel& definition, const UnitDimension& derived);
  [[nodiscard]] bool is_anything_missing() const;
  [[nodiscard]] const Channel* find(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> all_names() const;
  void check_names();
  void check_patterns();

  SystemBuilder& builder_;
  const Model& model_;
  std::vector<Defined> formulas_;
  std::vector<Share> shares_;
  std::vector<std::size_t> counts_; ///< of entries in groups, before the element
  std::size_t rows_ = 0, frictions_ = 0;
  bool has_requests_; ///< the model asks for something
  bool wants_shares_; ///< there may be energies of elements among it
};

} // namespace steplap
