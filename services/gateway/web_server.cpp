#include "services/gateway/web_server.hpp"

#include <chrono>
#include <thread>

#include "services/gateway/connection.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

namespace slammot::gateway {
namespace {

using boost::asio::ip::tcp;

constexpr std::chrono::milliseconds kPauseAfterFault{100};  ///< When no file handle is left.

std::string new_session() {
  return std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
}

tcp::endpoint endpoint_of(const WebServerSettings& settings) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(settings.address, error);
  if (error) throw std::invalid_argument("not an address: " + settings.address);
  return {address, settings.port};
}

}  // namespace

/// Members are destroyed in reverse order: connections end before what they share.
class WebServer::Implementation {
 public:
  explicit Implementation(const WebServerSettings& settings)
      : most_connections_(settings.most_connections),
        hub_(settings.access, settings.limits, new_session()),
        acceptor_(io_),
        pause_(io_) {
    hub_.on_call(settings.on_call);
    listen(endpoint_of(settings));
    accept();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~Implementation() {
    io_.stop();
    thread_.join();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  template <typename Work>
  void in_server_thread(Work work) {
    boost::asio::post(io_, std::move(work));
  }
  Hub& hub() { return hub_; }
  const Hub& hub() const { return hub_; }
  std::uint16_t port() const { return port_; }

 private:
  void listen(const tcp::endpoint& endpoint) try {
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    port_ = acceptor_.local_endpoint().port();
  } catch (const boost::system::system_error& fault) {
    throw std::runtime_error("cannot serve " + endpoint.address().to_string() + " port " +
                             std::to_string(endpoint.port()) + ": " + fault.code().message());
  }

  void accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error) return accept_later();
      if (hub_.counts.connections < most_connections_) {
        socket.set_option(tcp::no_delay(true), error);
        serve_http(std::move(socket), hub_);
      } else {
        ++hub_.counts.refused_connections;
      }
      accept();
    });
  }

  void accept_later() {
    pause_.expires_after(kPauseAfterFault);
    pause_.async_wait([this](boost::system::error_code) { accept(); });
  }

  std::uint64_t most_connections_;
  Hub hub_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

WebServer::WebServer(const WebServerSettings& settings)
    : implementation_(std::make_unique<Implementation>(settings)) {}
WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const { return implementation_->port(); }

void WebServer::put(const std::string& path, Content content) {
  implementation_->in_server_thread(
      [&hub = implementation_->hub(), path, content = std::move(content)]() mutable {
        hub.put(path, std::move(content));
      });
}

void WebServer::remove(const std::string& path) {
  implementation_->in_server_thread([&hub = implementation_->hub(), path] { hub.remove(path); });
}

bool WebServer::is_wanted(ChannelId channel) const {
  return implementation_->hub().is_wanted(channel);
}

void WebServer::publish(ChannelId channel, std::int64_t time_ns, std::string payload) {
  const Message message{channel, static_cast<std::uint64_t>(time_ns),
                        std::make_shared<const std::string>(std::move(payload))};
  implementation_->in_server_thread(
      [&hub = implementation_->hub(), message] { hub.publish(message); });
}

HubCounters WebServer::counters() const { return implementation_->hub().counters(); }

}  // namespace slammot::gateway
