// Machines for static proofs: models from TOML text.
#pragma once

#include "mbd/io/reader.h"
#include "tools/assess/static_proof.h"
#include "transformer/catalog.h"
#include "transformer/program.h"

#include <memory>
#include <string>

namespace steplap::testing {

inline std::shared_ptr<const LoadedModel> machine(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Model model = parse_model(text, "machine.toml", transformer_catalog(), overrides);
  std::shared_ptr<const System> system = compile(model);
  return load_completed(std::move(model), std::move(system), "machine.toml");
}

/// A block of 1 t on two feet 2 b apart, its centre of gravity h above the deck. Feet of 1 GN/m sink by 5 µm.
inline std::string block_on_deck(double b, double h, double mu, const std::string& more = "") {
  const auto n = [](double x) { return std::to_string(x); };
  std::string text =
      "[[body]]\nname = 'block'\nmass = 1000\ninertia = " + n(1000.0 * (b * b + h * h) / 3.0) + "\nposition = [0, " + n(h) + "]\n";
  for (const double side : {-1.0, 1.0})
    text += "[[element]]\nkind = 'unilateral_contact'\nname = '" + std::string(side < 0.0 ? "rear foot" : "front foot") +
            "'\na = { body = 'block', at = [" + n(side * b) +
            ", 0] }\nb = { body = 'ground', at = [0, 0] }\nnormal = [0, 1]\nstiffness = 1e9\ndamping = 1e6\n";
  return text + "[[element]]\nkind = 'coulomb_stick'\nname = 'deck'\ncontacts = ['rear foot', 'front foot']\nstatic_friction = " + n(mu) +
         "\n" + more;
}

inline assess::StaticPreset one_load(const Vec2& pull) { return {"own", "a test", {{"the load", pull, ""}}}; }

} // namespace steplap::testing
