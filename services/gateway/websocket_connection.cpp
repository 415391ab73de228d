#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "services/gateway/connection.hpp"

#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket.hpp>

#include "services/gateway/protocol.hpp"

namespace slammot::gateway {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr std::size_t kMostMessageBytes = 65536;  ///< From a client.
constexpr std::size_t kMostSubscriptions = 256;   ///< Of one client.
constexpr int kMostFaults = 100;                  ///< Of one client.

websocket::stream_base::timeout timeouts() {
  using std::chrono::seconds;
  return {seconds{5}, seconds{20}, true};  // handshake; silence, half of it before a ping
}

class WebsocketConnection : public std::enable_shared_from_this<WebsocketConnection>,
                            public Viewer {
 public:
  WebsocketConnection(beast::tcp_stream stream, UpgradeRequest request, Hub& hub)
      : request_(std::move(request)), socket_(std::move(stream)), hub_(hub), queue_(hub.limits()) {
    ++hub_.counts.connections;
    ++hub_.counts.viewers;
  }
  ~WebsocketConnection() override {
    close();
    --hub_.counts.connections;
    --hub_.counts.viewers;
  }
  WebsocketConnection(const WebsocketConnection&) = delete;
  WebsocketConnection& operator=(const WebsocketConnection&) = delete;

  void start() {
    beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timer
    socket_.set_option(timeouts());
    socket_.read_message_max(kMostMessageBytes);
    const auto requested = request_[beast::http::field::sec_websocket_protocol];
    const std::string chosen(choose_subprotocol({requested.data(), requested.size()}));
    socket_.set_option(
        websocket::stream_base::decorator([chosen](websocket::response_type& response) {
          response.set(beast::http::field::sec_websocket_protocol, chosen);
          response.set(beast::http::field::server, "slammot");
        }));
    socket_.async_accept(request_, [self = shared_from_this()](beast::error_code error) {
      if (!error) self->greet();
    });
  }

  void deliver(const Message& message) override {
    for (const auto& [subscription, channel] : channels_) {
      if (channel == message.channel) send(subscription, message);
    }
  }

 private:
  void greet() {
    hub_.add(*this);
    is_open_ = true;
    for (const auto& text : hub_.greeting()) push({std::nullopt, text});
    read();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->close();
      self->handle();
      if (self->is_open_) self->read();
    });
  }

  void handle() {
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (!socket_.got_text()) return call(text);
    const ClientMessage message = parse_client_message(text);
    if (const auto* subscribe = std::get_if<Subscribe>(&message)) take(*subscribe);
    if (const auto* unsubscribe = std::get_if<Unsubscribe>(&message)) take(*unsubscribe);
    if (const auto* refused = std::get_if<Refused>(&message)) refuse(refused->reason);
  }

  void call(const std::string& bytes) {
    const auto request = parse_service_call(bytes);
    if (!request) return refuse("a call of no service");
    auto answer = [self = weak_from_this(), executor = socket_.get_executor(),
                   request = *request](const std::string& explanation) {
      boost::asio::post(executor, [self, request, explanation] {
        if (const auto connection = self.lock()) connection->answer(request, explanation);
      });
    };
    hub_.call({&callable_services()[request->service], request->argument, std::move(answer)});
  }

  void answer(const ServiceCall& request, const std::string& explanation) {
    const bool is_done = explanation.empty();
    push({std::nullopt,
          std::make_shared<const std::string>(is_done ? service_response(request)
                                                      : call_failure(request, explanation)),
          is_done});
  }

  void take(const Subscribe& subscribe) {
    for (const Subscription& subscription : subscribe.subscriptions) {
      if (channels_.size() >= kMostSubscriptions ||
          !channels_.emplace(subscription.id, subscription.channel).second) {
        refuse("too many subscriptions, or one with an id in use");
        continue;
      }
      hub_.count_subscribers(subscription.channel, 1);
      if (const auto last = hub_.last(subscription.channel)) send(subscription.id, *last);
    }
  }

  void take(const Unsubscribe& unsubscribe) {
    for (const std::uint32_t id : unsubscribe.subscriptions) {
      const auto found = channels_.find(id);
      if (found == channels_.end()) continue;
      hub_.count_subscribers(found->second, -1);
      channels_.erase(found);
    }
  }

  void refuse(const std::string& reason) {
    ++hub_.counts.refused_messages;
    if (++faults_ > kMostFaults) return close();
    push({std::nullopt, std::make_shared<const std::string>(
                            status_message(Severity::kError, "message refused: " + reason))});
  }

  void send(std::uint32_t subscription, const Message& message) {
    push({data_header(subscription, message.time_ns), message.payload});
  }

  void push(Outgoing message) {
    const std::uint64_t dropped_before = queue_.dropped();
    if (queue_.push(std::move(message)) == SendQueue::Pushed::kGaveUp) return close();
    hub_.counts.dropped_messages += queue_.dropped() - dropped_before;
    if (!is_writing_) write();
  }

  void write() {
    if (queue_.empty() || !is_open_) return;
    is_writing_ = true;
    sending_ = queue_.pop();
    socket_.binary(sending_.header.has_value() || sending_.is_binary);
    const auto done = [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
      self->is_writing_ = false;
      if (error) return self->close();
      ++self->hub_.counts.sent_messages;
      self->hub_.counts.sent_bytes += bytes;
      self->write();
    };
    const boost::asio::const_buffer payload = boost::asio::buffer(*sending_.payload);
    if (!sending_.header) return socket_.async_write(payload, done);
    socket_.async_write(
        std::array{boost::asio::const_buffer(boost::asio::buffer(*sending_.header)), payload},
        done);
  }

  /// The object lives until its last pending operation has been cancelled.
  void close() {
    if (!is_open_) return;
    is_open_ = false;
    hub_.remove(*this);
    for (const auto& [subscription, channel] : channels_) hub_.count_subscribers(channel, -1);
    channels_.clear();
    beast::get_lowest_layer(socket_).close();
  }

  UpgradeRequest request_;
  websocket::stream<beast::tcp_stream> socket_;
  Hub& hub_;
  beast::flat_buffer buffer_;
  SendQueue queue_;
  Outgoing sending_;
  std::map<std::uint32_t, ChannelId> channels_;  ///< By subscription.
  bool is_open_ = false;
  bool is_writing_ = false;
  int faults_ = 0;
};

}  // namespace

void serve_websocket(beast::tcp_stream stream, UpgradeRequest request, Hub& hub) {
  std::make_shared<WebsocketConnection>(std::move(stream), std::move(request), hub)->start();
}

}  // namespace slammot::gateway
