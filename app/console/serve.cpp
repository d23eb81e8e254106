// SPDX-License-Identifier: Apache-2.0
#include "app/console/serve.h"

#include "base/error.h"

#ifdef EARTHSHINE_HTTPLIB

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>

#include <csignal>
#include <thread>

#include "app/console.h"
#include "app/console/assets.h"
#include "app/console/live_scene.h"
#include "app/console/page.h"

namespace earthshine::app {
namespace {

constexpr std::size_t most_body_bytes = std::size_t{64} << 10;
constexpr std::time_t patience_s = 5;
constexpr std::size_t most_connections = 8;
constexpr int no_picture = 204;  // No Content: a newer request came

// 128 random bits as hexadecimal digits.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw base::Error(base::Blame::Work, "--serve", "the system gives no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

// The time does not depend on where the texts differ.
bool is_equal(const std::string& given, const std::string& wanted) {
  unsigned difference = given.size() == wanted.size() ? 0U : 1U;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const char one = k < given.size() ? given[k] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(one) ^
                                        static_cast<unsigned char>(wanted[k]));
  }
  return difference == 0;
}

void say(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

class Server {
 public:
  Server(LiveScene& scene, std::string token) : scene_(scene), token_(std::move(token)) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(most_connections); };
    // Without SO_REUSEPORT, which the library sets: a second server on the port is refused.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_payload_max_length(most_body_bytes);
    server_.set_read_timeout(patience_s);
    server_.set_keep_alive_timeout(patience_s);
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"}});
    server_.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& response) {
          return refuses(request, response) ? httplib::Server::HandlerResponse::Handled
                                            : httplib::Server::HandlerResponse::Unhandled;
        });
    server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (!response.body.empty()) return;
      say(response, response.status,
          response.status == 413 ? "the body has more than 64 KiB"
                                 : fmt::format("status {}", response.status));
    });
    server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(page(), "text/html; charset=utf-8");
    });
    server_.Post("/draw", [this](const httplib::Request& request, httplib::Response& response) {
      draw(request, response);
    });
  }

  [[nodiscard]] int bind(int port) {
    const char* host = "127.0.0.1";
    const int bound =
        port == 0 ? server_.bind_to_any_port(host) : (server_.bind_to_port(host, port) ? port : -1);
    if (bound <= 0) {
      throw base::Error(base::Blame::Input, "--port", fmt::format("{} is not free", port), {},
                        "Name another, or leave it out for a free one");
    }
    hosts_ = {fmt::format("127.0.0.1:{}", bound), fmt::format("localhost:{}", bound)};
    return bound;
  }
  void listen() { server_.listen_after_bind(); }
  void stop() { server_.stop(); }

 private:
  // Answers and returns true unless the request is the page's own.
  bool refuses(const httplib::Request& request, httplib::Response& response) const {
    const std::string host = request.get_header_value("Host");
    const bool known = std::ranges::find(hosts_, host) != hosts_.end();
    if (!known || request.get_header_value_count("Host") != 1) {
      say(response, 403, "another host's name");
    } else if (request.has_header("Origin") &&
               request.get_header_value("Origin") != "http://" + host) {
      say(response, 403, "from another origin");
    } else if (request.get_param_value_count("token") != 1 ||
               !is_equal(request.get_param_value("token"), token_)) {
      say(response, 403, "without the token");
    } else {
      return false;
    }
    return true;
  }

  [[nodiscard]] std::string page() {
    return page_of({"Live preview", std::string(console_style()) + std::string(live_style()),
                    live_body(), live_script(), live_script_hash(), true},
                   scene_.description(), {});
  }

  void draw(const httplib::Request& request, httplib::Response& response) {
    try {
      if (auto answer = scene_.draw(read_live_request(request.body))) {
        response.set_content(std::move(*answer), "application/octet-stream");
      } else {
        response.status = no_picture;
      }
    } catch (const base::Error& error) {
      say(response, error.blame() == base::Blame::Input ? 400 : 500, error.what());
    } catch (const Interrupt::Left&) {
      response.status = no_picture;
    } catch (const std::exception& error) {
      say(response, 500, error.what());
    }
  }

  LiveScene& scene_;
  std::string token_;
  std::vector<std::string> hosts_;
  httplib::Server server_;
};

}  // namespace

bool can_serve() { return true; }

void serve(const SceneInput& scene, int port, const Common& common) {
  // Blocked in all threads, so that one waits for them.
  sigset_t ending;
  sigemptyset(&ending);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ending, signal);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  Interrupt::leave_signals_to_host();
  LiveScene live(scene, common);
  const std::string token = random_token();
  Server server(live, token);
  const int bound = server.bind(port);
  std::thread([&ending, &server] {
    int signal = 0;
    sigwait(&ending, &signal);
    Interrupt::ask(true);
    server.stop();
    // A picture that is being drawn need not end first: nothing is written.
    std::fflush(nullptr);
    std::_Exit(0);
  }).detach();
  print(fmt::format("http://127.0.0.1:{}/?token={}\n", bound, token));
  std::fflush(stdout);
  if (!common.quiet) note("Open this address in a browser of this machine; Ctrl-C ends it.");
  be_silent(true);
  server.listen();
}

}  // namespace earthshine::app

#else

namespace earthshine::app {

bool can_serve() { return false; }

void serve(const SceneInput&, int, const Common&) {
  throw base::Error(base::Blame::Input, "--serve", "is not in this build", {},
                    "Build with libcpp-httplib-dev installed");
}

}  // namespace earthshine::app

#endif
