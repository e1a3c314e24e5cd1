// Finds the user at the other end of a local TCP connection in Linux's socket table /proc/net/tcp (proc(5)).
#pragma once

#include <optional>
#include <string>

namespace steplap {

/// Returns the user id of the socket that connects 127.0.0.1:`from` to 127.0.0.1:`to`. `table` is the text of /proc/net/tcp. Returns
/// nothing if no such connection is established: a closed socket is listed under user 0, regardless of its owner.
[[nodiscard]] std::optional<unsigned> user_of_connection(const std::string& table, unsigned short from, unsigned short to);

/// Returns the text of /proc/net/tcp; "" if it cannot be read.
[[nodiscard]] std::string tcp_table();

} // namespace steplap
