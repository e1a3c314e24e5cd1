// Who is let in: each rule of the gate by itself, with everything else as it should be.
#include "tools/explore/gate.h"

#include <doctest/doctest.h>

#include <set>

using namespace steplap;

namespace {

constexpr unsigned short k_port = 4242;
const std::string k_token = "0123456789abcdef0123456789abcdef";

RequestHead good(const std::string& method) {
  RequestHead head{method,
                   "/" + k_token + "/run",
                   "127.0.0.1:4242",
                   method == "POST" ? "http://127.0.0.1:4242" : "",
                   "",
                   method == "POST" ? "application/json" : ""};
  return head;
}

} // namespace

TEST_CASE("what the page itself asks is let in") {
  const Gate gate(k_port, k_token);
  CHECK(gate.refusal(good("GET")) == "");
  CHECK(gate.refusal(good("POST")) == "");
  RequestHead typed = good("GET"); // into the address line
  typed.fetch_site = "none";
  CHECK(gate.refusal(typed) == "");
}

TEST_CASE("one thing that is wrong is enough to be refused") {
  const Gate gate(k_port, k_token);
  for (const char* method : {"GET", "POST"}) {
    for (const char* target : {"", "/", "/0123456789abcdef0123456789abcdee/run", "/0123456789abcdef0123456789abcdef", "/0123456789abcdef/",
                               "0123456789abcdef0123456789abcdef/"}) {
      RequestHead head = good(method);
      head.target = target;
      CHECK_MESSAGE(gate.refusal(head) != "", target);
    }
    for (const char* host :
         {"", "127.0.0.1", "127.0.0.1:4243", "localhost:4242", "evil.example:4242", "127.0.0.1:4242.evil.example", "[::1]:4242"}) {
      RequestHead head = good(method);
      head.host = host;
      CHECK_MESSAGE(gate.refusal(head) != "", host);
    }
    for (const char* origin :
         {"null", "http://evil.example", "https://127.0.0.1:4242", "http://127.0.0.1", "http://localhost:4242", "http://127.0.0.1:4242/"}) {
      RequestHead head = good(method);
      head.origin = origin;
      CHECK_MESSAGE(gate.refusal(head) != "", origin);
    }
    for (const char* site : {"cross-site", "same-site", "anything"}) {
      RequestHead head = good(method);
      head.fetch_site = site;
      CHECK_MESSAGE(gate.refusal(head) != "", site);
    }
    RequestHead twice = good(method);
    twice.host_headers = 2;
    CHECK(gate.refusal(twice) != "");
  }
  for (const char* method : {"HEAD", "PUT", "OPTIONS", "get", ""}) {
    RequestHead head = good("GET");
    head.method = method;
    CHECK_MESSAGE(gate.refusal(head) != "", method);
  }
  RequestHead nameless = good("POST");
  nameless.origin = "";
  CHECK(gate.refusal(nameless) != "");
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"}) { // what a form of another site can send
    RequestHead form = good("POST");
    form.content_type = type;
    CHECK_MESSAGE(gate.refusal(form) != "", type);
  }
}

TEST_CASE("the first address serves once, from nowhere else") {
  Gate gate(k_port, k_token);
  RequestHead first = good("GET");
  first.target = gate.first_path();
  RequestHead foreign = first;
  foreign.origin = "http://evil.example";
  CHECK(gate.refusal(foreign) != "");
  CHECK(gate.refusal(first) == "");
  RequestHead near = first;
  near.target.back() = near.target.back() == '0' ? '1' : '0';
  CHECK_FALSE(gate.is_first_use(near));
  CHECK(gate.is_first_use(first));
  CHECK_FALSE(gate.is_first_use(first));
}

TEST_CASE("tokens are long and new each time") {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = random_token();
    CHECK(token.size() == 32);
    CHECK(token.find_first_not_of("0123456789abcdef") == std::string::npos);
    seen.insert(token);
  }
  CHECK(seen.size() == 1000); // two alike of 2^128 would be no chance
}

TEST_CASE("secrets are compared as wholes") {
  CHECK(is_same_secret("", ""));
  CHECK(is_same_secret("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abd", "Abc"}) CHECK_FALSE(is_same_secret("abc", other));
}
