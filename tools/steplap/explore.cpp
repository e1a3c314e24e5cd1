#include "tools/steplap/commands.h"

#include "mbd/io/read_input.h"
#include "tools/explore/explorer.h"
#include "tools/explore/local_server.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/log.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

struct ExploreOptions {
  std::vector<std::string> models, overrides;
  std::optional<std::string> port;
  bool is_without_browser = false;
};

struct ExplorerEnd {
  Explorer& explorer;
  ~ExplorerEnd() { explorer.end(); }
};

unsigned short port_of(const ExploreOptions& options) {
  if (!options.port) return 0;
  unsigned short port = 0;
  const char* const end = options.port->data() + options.port->size();
  const auto [last, error] = std::from_chars(options.port->data(), end, port);
  if (error != std::errc() || last != end || port < 1024)
    throw UsageError("--port takes a whole number from 1024 to 65535, not '" + *options.port + "'");
  return port;
}

// Starts the browser without a shell, as a process that is independent of this program and never becomes a zombie. Returns false if it
// cannot be started.
bool open_browser(const std::string& address) {
  std::string words[] = {"xdg-open", address};
  char* arguments[] = {words[0].data(), words[1].data(), nullptr};
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    if (fork() != 0) _exit(0);
    setsid();
    const int nowhere = open("/dev/null", O_RDWR); // discards the output of the browser
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, descriptor);
    execvp(arguments[0], arguments);
    const char failed = 1;
    (void)!write(ends[1], &failed, 1);
    _exit(127); // the program does not exist
  }
  close(ends[1]);
  if (child > 0) waitpid(child, nullptr, 0);
  char failed = 0;
  const bool is_open = child > 0 && read(ends[0], &failed, 1) == 0; // the pipe closes without data when the browser has been started
  close(ends[0]);
  return is_open;
}

ExitCode explore(const ExploreOptions& options, Console& console) {
  for (const std::string& model : options.models)
    if (is_standard_input(model)) throw UsageError("explore watches files: give the model as a file, not through a pipe");
  const unsigned short port = port_of(options);
  Explorer explorer(options.models, options.overrides);
  const InterruptionGuard guard;
  LocalServer server(port, [&explorer](const PageRequest& request, const SendReply& send) { explorer.answer(request, send); });
  const ExplorerEnd ending{explorer}; // must be destroyed before the server, because waiting requests hold connections
  console.out << server.address() << "\n" << std::flush;
  if (!console.out) return ExitCode::done; // the address could not be printed; reported as an output error
  const bool has_screen = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
  if (!options.is_without_browser && (!has_screen || !open_browser(server.first_address())))
    log_info("No browser could be opened: open the address in one");
  if (console.verbosity != Verbosity::quiet)
    console.out << "The page is served on this computer only, to anyone who has this address. Ctrl-C ends it.\n" << std::flush;
  server.run([&explorer] {
    if (recorded_signal() != 0) return false;
    explorer.tick();
    return true;
  });
  return ExitCode::done;
}

} // namespace

Command explore_command() {
  const auto o = std::make_shared<ExploreOptions>();
  Command command;
  command.name = "explore";
  command.summary = "a page in the browser that runs models while you drag their values";
  command.examples = R"(  steplap explore my.toml
  steplap explore models/paper/no_interference.toml --set simulation.end="0.4 s"
  steplap explore my.toml --no-browser --port 8765
A page with a slider for each value: parameters of the model with their ranges first, then friction, pressures, gaps and stiffnesses, and any
other number by search. While one drags, the model runs anew; old and new machine, curves, events and limits stand beside each other. A map of
two values fills in while one looks. The model's file is watched: what an editor saves is shown, or what is wrong with it and where. Changes
are saved as a file that extends the model's; nothing else is written. The page is served on 127.0.0.1 only, and only to whoever has the
address that is printed, with its token. Ctrl-C ends it.
)";
  command.options = {{"MODEL", &o->models, "FILE", "model files (TOML)", true},
                     {"--set", &o->overrides, "PATH=VALUE", "another value than the file's, whatever is varied; may be repeated"},
                     {"--port", &o->port, "N", "the port of the address (default: one that is free)"},
                     {"--no-browser", &o->is_without_browser, "", "print the address only; open no browser"}};
  command.run = [o](Console& console) { return explore(*o, console); };
  return command;
}

} // namespace steplap
