// Queries of a study that was read: names, numbers, and locations of variables and responses in the models.
#include "mbd/base/name_pattern.h"
#include "tools/study/study_reader.h"

#include <algorithm>

namespace steplap::study {

bool is_set_in(const Variable& v, const StudyModel& model) {
  return v.model.empty() || v.model == model.name || v.model == model.file_name;
}

std::vector<const Channel*> channels_of(const Response& response, const System& system) {
  std::vector<const Channel*> found;
  for (const Channel& c : system.channels)
    if (!response.channel.empty() && matches_pattern(c.name, response.channel)) found.push_back(&c);
  return found;
}

std::vector<std::string> LoadedStudy::variable_names() const {
  std::vector<std::string> names;
  for (const Variable& v : study.variables) names.push_back(v.name);
  return names;
}

std::vector<std::string> LoadedStudy::number_names() const {
  std::vector<std::string> names;
  for (const Response& r : study.responses) names.push_back(r.name);
  for (const LimitState& l : study.limit_states) names.push_back(l.name);
  return names;
}

std::vector<std::string> LoadedStudy::number_units() const {
  std::vector<std::string> units;
  for (const Response& r : study.responses) units.push_back(r.unit);
  units.resize(number_count());
  return units;
}

std::size_t LoadedStudy::curve_size() const {
  std::size_t size = 0;
  for (const History& h : study.histories) size += h.t.size();
  return size;
}

std::string LoadedStudy::changed_record() const {
  for (const auto& model : models)
    for (const InputFile& file : model->files)
      if (file.is_record && sha256_of_file(file.path) != file.sha256) return file.path;
  return "";
}

int LoadedStudy::index_of_number(const std::string& name) const {
  const std::vector<std::string> names = number_names();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

} // namespace steplap::study
