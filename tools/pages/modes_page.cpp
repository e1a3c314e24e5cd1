#include "tools/pages/modes_page.h"

#include "mbd/run/ordered_json.h"
#include "mbd/run/version.h"
#include "tools/pages/report_data.h"
#include "tools/pages/report_page.h"
#include "tools/pages/run/assets.h"

#include <nlohmann/json.hpp>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

Json poses_json(const System& system, const State& state) {
  Json poses = Json::object();
  for (int i = 1; i < system.body_count(); ++i)
    append(poses, system.bodies[i].name) = {state.q[3 * i], state.q[3 * i + 1], state.q[3 * i + 2]};
  return poses;
}

Json mode_json(const System& system, const VibrationMode& mode, const std::string& moves_most) {
  Json shape = Json::object();
  for (int i = 1; i < system.body_count(); ++i) {
    Json parts = Json::array();
    for (int c = 0; c < 3; ++c) {
      const std::complex<double>& part = mode.shape[3 * i + c];
      parts.push_back({part.real(), part.imag()});
    }
    append(shape, system.bodies[i].name) = std::move(parts);
  }
  return {{"natural_frequency", mode.natural_frequency()},
          {"frequency", mode.frequency()},
          {"damping_ratio", mode.damping_ratio()},
          {"real", mode.eigenvalue.real()},
          {"imaginary", mode.eigenvalue.imag()},
          {"moves_most", moves_most},
          {"shape", std::move(shape)}};
}

} // namespace

std::string modes_page(const LoadedModel& loaded, const Equilibrium& rest, const VibrationModes& found,
                       const std::vector<std::string>& moves_most, const std::vector<std::string>& remarks) {
  Json modes = Json::array();
  for (std::size_t i = 0; i < found.modes.size(); ++i) modes.push_back(mode_json(*loaded.system, found.modes[i], moves_most[i]));
  const Json data{{"program", std::string("steplap ") + k_version},
                  {"runs", Json::array({run_without_histories(loaded)})},
                  {"modes",
                   {{"title", loaded.model.header.title},
                    {"rest", poses_json(*loaded.system, rest.state)},
                    {"rigid_motions", found.rigid_motions},
                    {"remarks", remarks},
                    {"modes", std::move(modes)}}}};
  namespace assets = report_assets;
  return filled_page(assets::k_modes_html, {{"PAGE_TITLE", escaped_html("steplap modes: " + loaded.name)},
                                            {"PAGE_CSS", std::string(assets::k_page_css)},
                                            {"DATA", in_script(data.dump(-1, ' ', false, Json::error_handler_t::replace))},
                                            {"PAGE_JS", std::string(assets::k_modes_js)}});
}

} // namespace steplap
