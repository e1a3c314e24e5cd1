#include "mbd/run/ordered_json.h"

#include <utility>
#include <vector>

namespace steplap {

namespace {

// Builds a document from the callbacks of the parser.
class Builder final : public nlohmann::json_sax<OrderedJson> {
public:
  explicit Builder(OrderedJson& root) : root_(root) {}

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t&) override { return put(value); }
  bool string(string_t& value) override { return put(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(OrderedJson::object()); }
  bool start_array(std::size_t) override { return open(OrderedJson::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    name_ = std::move(name);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

private:
  template <class Value> OrderedJson& add(Value&& value) {
    if (open_.empty()) return root_ = std::forward<Value>(value);
    OrderedJson& parent = *open_.back();
    if (parent.is_object()) return append(parent, std::move(name_)) = std::forward<Value>(value);
    parent.push_back(std::forward<Value>(value));
    return parent.back();
  }
  template <class Value> bool put(Value&& value) {
    add(std::forward<Value>(value));
    return true;
  }
  bool open(OrderedJson container) {
    open_.push_back(&add(std::move(container)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  OrderedJson& root_;
  /// Containers being filled, from the root inwards; each is the last entry of the previous one, whose size does not change meanwhile.
  std::vector<OrderedJson*> open_;
  std::string name_;
};

} // namespace

OrderedJson object_with_room(std::size_t entries) {
  OrderedJson object = OrderedJson::object();
  object.get_ref<OrderedJson::object_t&>().reserve(entries);
  return object;
}

OrderedJson& append(OrderedJson& object, std::string name) {
  auto& entries = object.get_ref<OrderedJson::object_t&>();
  entries.emplace_back(std::move(name), OrderedJson());
  return entries.back().second;
}

OrderedJson parse_ordered(const std::string& text) {
  OrderedJson json;
  Builder builder(json);
  if (!OrderedJson::sax_parse(text, &builder)) return OrderedJson(OrderedJson::value_t::discarded);
  return json;
}

} // namespace steplap
