#include "tools/explore/local_server.h"

#include "mbd/base/diagnostics.h"
#include "tools/explore/peer_user.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <optional>

namespace steplap {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Response = http::response<http::string_body>;

std::string text_of(boost::string_view text) { return std::string(text.data(), text.size()); }

RequestHead head_of(const http::request<http::string_body>& request) {
  const auto header = [&](boost::string_view name) {
    const auto found = request.find(name);
    return found == request.end() ? std::string() : text_of(found->value());
  };
  const int hosts = static_cast<int>(request.count(http::field::host));
  return {text_of(request.method_string()), text_of(request.target()), header("Host"), header("Origin"),
          header("Sec-Fetch-Site"),         header("Content-Type"),    hosts};
}

// Adds headers so that the browser neither stores the page, nor sends its address to other sites, nor shows it in a frame of another site.
Response response_of(PageReply reply, bool keeps_open) {
  Response response(static_cast<http::status>(reply.status), 11);
  response.set(http::field::content_type, reply.type);
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("X-Frame-Options", "DENY");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Content-Security-Policy", reply.policy.empty() ? "default-src 'none'; frame-ancestors 'none'" : reply.policy);
  if (!reply.location.empty()) response.set(http::field::location, reply.location);
  response.keep_alive(keeps_open);
  response.body() = std::move(reply.body);
  response.prepare_payload();
  return response;
}

// Data shared by the server and its connections. It exists until the last connection is closed.
struct Shared {
  Shared(unsigned short port, LocalServer::Answer given) : gate(port, random_token()), answer(std::move(given)) {}
  Gate gate;
  LocalServer::Answer answer;
  int connections = 0;
};

// Returns the reason for refusing a connection; "" if it comes from the user who runs the server.
std::string refusal_of(const tcp::socket& socket) {
  beast::error_code no_peer, no_socket;
  const tcp::endpoint from = socket.remote_endpoint(no_peer), to = socket.local_endpoint(no_socket);
  if (no_peer || no_socket) return "the connection is closed";
  const std::optional<unsigned> user = user_of_connection(tcp_table(), from.port(), to.port());
  if (user == ::geteuid()) return "";
  return "the page is served only to the user who started steplap (a proxy has to run as that user, on the same computer or container)";
}

// One connection: reads a request, sends the reply, then reads the next request.
class Connection : public std::enable_shared_from_this<Connection> {
public:
  Connection(tcp::socket socket, std::shared_ptr<Shared> shared)
      : refusal_(refusal_of(socket)), stream_(std::move(socket)), shared_(std::move(shared)) {
    ++shared_->connections;
  }
  ~Connection() { --shared_->connections; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(LocalServer::k_longest_header);
    parser_->body_limit(LocalServer::k_longest_body);
    stream_.expires_after(std::chrono::seconds(LocalServer::k_patience));
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) { self->on_read(error); });
  }

private:
  void on_read(beast::error_code error) {
    if (error == http::error::body_limit || error == http::error::buffer_overflow || error == http::error::header_limit)
      return send({413, "text/plain; charset=utf-8", "The request is too long.\n"}, false);
    if (error && error.category() == http::make_error_code(http::error::bad_method).category() && error != http::error::end_of_stream &&
        error != http::error::partial_message)
      return send({400, "text/plain; charset=utf-8", "That is no request.\n"}, false);
    if (error) return; // the connection was closed or timed out
    const http::request<http::string_body>& request = parser_->get();
    const RequestHead head = head_of(request);
    keeps_open_ = request.keep_alive();
    if (!refusal_.empty()) return send({403, "text/plain; charset=utf-8", "Refused: " + refusal_ + ".\n"}, false);
    if (const std::string why = shared_->gate.refusal(head); !why.empty())
      return send({403, "text/plain; charset=utf-8", "Refused: " + why + ".\n"}, false);
    if (shared_->gate.is_first_use(head)) {
      PageReply reply{303, "text/plain; charset=utf-8", ""};
      reply.location = shared_->gate.folder();
      return send(std::move(reply), keeps_open_);
    }
    const std::string& folder = shared_->gate.folder();
    if (!head.target.starts_with(folder)) return send({403, "text/plain; charset=utf-8", "Refused: this address served once.\n"}, false);
    hand_over(head, request.body());
  }

  void hand_over(const RequestHead& head, const std::string& body) {
    const std::string rest = head.target.substr(shared_->gate.folder().size());
    const std::size_t mark = rest.find('?');
    PageRequest asked{head.method == "POST", rest.substr(0, mark), mark == std::string::npos ? "" : rest.substr(mark + 1), body};
    asked.is_gone = is_gone_;
    watch_for_close();
    // A worker thread may send the reply, so the connection must be kept alive until then.
    shared_->answer(std::move(asked), [self = shared_from_this(), executor = stream_.get_executor()](PageReply reply) {
      asio::post(executor, [self, reply = std::move(reply)]() mutable { self->send(std::move(reply), self->keeps_open_); });
    });
  }

  // Waits until the socket becomes readable during a computation: the client has closed it, or has sent the next request early.
  void watch_for_close() {
    stream_.socket().async_wait(tcp::socket::wait_read, [self = shared_from_this()](beast::error_code error) {
      if (error) return; // the wait was cancelled because the reply is ready
      char next = 0;
      beast::error_code closed;
      self->stream_.socket().receive(asio::buffer(&next, 1), tcp::socket::message_peek, closed);
      if (closed) *self->is_gone_ = true;
    });
  }

  void send(PageReply reply, bool keeps_open) {
    beast::error_code not_cancelled;
    stream_.socket().cancel(not_cancelled);
    response_.emplace(response_of(std::move(reply), keeps_open));
    stream_.expires_after(std::chrono::seconds(LocalServer::k_patience));
    http::async_write(stream_, *response_, [self = shared_from_this(), keeps_open](beast::error_code error, std::size_t) {
      self->response_.reset();
      if (!error && keeps_open) return self->read();
      beast::error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  std::string refusal_; ///< reason for refusing this connection; "" if it is permitted
  std::shared_ptr<std::atomic<bool>> is_gone_ = std::make_shared<std::atomic<bool>>(false);
  beast::tcp_stream stream_;
  std::shared_ptr<Shared> shared_;
  beast::flat_buffer buffer_{LocalServer::k_longest_header + LocalServer::k_longest_body};
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<Response> response_;
  bool keeps_open_ = false;
};

} // namespace

struct LocalServer::Implementation {
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io}, pause{io};
  std::shared_ptr<Shared> shared;

  Implementation(unsigned short port, Answer answer) {
    const tcp::endpoint place(asio::ip::address_v4::loopback(), port);
    beast::error_code error;
    acceptor.open(place.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(place, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      const std::string name = "127.0.0.1:" + std::to_string(port);
      throw FileError(name, "cannot serve on " + name + ": " + error.message() + "; choose another port, or none to have a free one found");
    }
    shared = std::make_shared<Shared>(acceptor.local_endpoint().port(), std::move(answer));
  }

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later(); // retries later: no file descriptor is free
      if (shared->connections < k_most_connections) {
        beast::error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<Connection>(std::move(socket), shared)->read();
      }
      accept();
    });
  }

  void accept_later() {
    pause.expires_after(std::chrono::milliseconds(k_tick));
    pause.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }

  void wait(const std::function<bool()>& tick) {
    timer.expires_after(std::chrono::milliseconds(k_tick));
    timer.async_wait([this, &tick](beast::error_code error) {
      if (error) return;
      if (tick()) wait(tick);
      else io.stop();
    });
  }
};

LocalServer::LocalServer(unsigned short port, Answer answer) : implementation_(std::make_shared<Implementation>(port, std::move(answer))) {}
LocalServer::~LocalServer() = default;

std::string LocalServer::address() const { return implementation_->shared->gate.origin() + implementation_->shared->gate.folder(); }

std::string LocalServer::first_address() const {
  return implementation_->shared->gate.origin() + implementation_->shared->gate.first_path();
}

void LocalServer::run(const std::function<bool()>& tick) {
  implementation_->accept();
  implementation_->wait(tick);
  implementation_->io.run();
}

void LocalServer::stop() { implementation_->io.stop(); }

} // namespace steplap
