#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "services/gateway/connection.hpp"

#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "services/gateway/protocol.hpp"

namespace slammot::gateway {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::asio::ip::tcp;

constexpr std::chrono::seconds kPatience{15};  ///< For a request, an answer or the next request.
constexpr std::uint32_t kMostHeaderBytes = 8192;

using Answer = http::response<http::string_body>;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

/// "/a" and "x=1" of "/a?x=1".
struct Target {
  std::string path;
  std::string query;
};

Target target_of(const UpgradeRequest& request) {
  const std::string target(view(request.target()));
  const std::size_t question = target.find('?');
  if (question == std::string::npos) return {target, ""};
  return {target.substr(0, question), target.substr(question + 1)};
}

Verdict verdict_on(const UpgradeRequest& request, const Target& target,
                   const boost::asio::ip::address& peer, const AccessRules& rules) {
  const std::string in_query = query_value(target.query, "token");
  const std::string_view in_header = bearer_token(view(request[http::field::authorization]));
  return verdict_on({peer.to_string(), peer.is_loopback(), view(request[http::field::host]),
                     view(request[http::field::origin]), in_query.empty() ? in_header : in_query},
                    rules);
}

/// A socket of both families has IPv4 peers as "::ffff:10.0.0.7".
boost::asio::ip::address plain(const boost::asio::ip::address& peer) {
  if (!peer.is_v6() || !peer.to_v6().is_v4_mapped()) return peer;
  return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, peer.to_v6());
}

Answer plain_answer(http::status status, std::string_view text) {
  Answer answer{status, 11};
  answer.set(http::field::content_type, "text/plain; charset=utf-8");
  answer.body() = std::string(text);
  return answer;
}

Answer refusal(Verdict verdict) {
  return plain_answer(
      verdict == Verdict::kNeedsToken ? http::status::unauthorized : http::status::forbidden,
      explanation_of(verdict));
}

Answer answer_with(const Content& content) {
  Answer answer{static_cast<http::status>(content.status), 11};
  answer.set(http::field::content_type, content.type);
  if (!content.encoding.empty()) answer.set(http::field::content_encoding, content.encoding);
  answer.set(http::field::cache_control,
             content.is_immutable ? "private, max-age=86400, immutable" : "no-cache");
  answer.body() = content.body;
  return answer;
}

/// The page may load nothing from elsewhere, and no other page may frame it.
void add_common_fields(Answer& answer) {
  answer.set(http::field::server, "slammot");
  answer.set("X-Content-Type-Options", "nosniff");
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("Content-Security-Policy",
             "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data:; "
             "frame-ancestors 'none'");
}

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Hub& hub) : stream_(std::move(socket)), hub_(hub) {
    ++hub_.counts.connections;
  }
  ~HttpConnection() { --hub_.counts.connections; }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void start() {
    beast::error_code error;
    const tcp::endpoint peer = stream_.socket().remote_endpoint(error);
    if (error) return;
    peer_ = plain(peer.address());
    read();
  }

 private:
  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->handle();
                     });
  }

  void handle() {
    const UpgradeRequest request = parser_->release();
    if (!beast::websocket::is_upgrade(request))
      return write(answer_to(request), request.keep_alive(), request.method() == http::verb::head);
    const Verdict verdict = verdict_on(request, target_of(request), peer_, hub_.access());
    if (verdict != Verdict::kAllowed) return write(refusal(verdict), false, false);
    if (choose_subprotocol(view(request[http::field::sec_websocket_protocol])).empty())
      return write(
          plain_answer(http::status::bad_request,
                       "sub-protocol foxglove.sdk.v1 or foxglove.websocket.v1 is needed\n"),
          false, false);
    serve_websocket(std::move(stream_), request, hub_);
  }

  Answer answer_to(const UpgradeRequest& request) const {
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return plain_answer(http::status::method_not_allowed, "GET only\n");
    const Target target = target_of(request);
    const auto content = hub_.content(target.path == "/" ? "/index.html" : target.path);
    if (content && content->is_public) return answer_with(*content);
    const Verdict verdict = verdict_on(request, target, peer_, hub_.access());
    if (verdict != Verdict::kAllowed) return refusal(verdict);
    if (!content) return plain_answer(http::status::not_found, "there is no such page\n");
    return answer_with(*content);
  }

  void write(Answer answer, bool keep_alive, bool without_body) {
    if (answer.result() == http::status::unauthorized || answer.result() == http::status::forbidden)
      ++hub_.counts.refused_connections;
    add_common_fields(answer);
    answer.keep_alive(keep_alive);
    answer.prepare_payload();
    if (without_body) answer.body().clear();
    stream_.expires_after(kPatience);
    answer_.emplace(std::move(answer));
    http::async_write(
        stream_, *answer_,
        [self = shared_from_this(), keep_alive](beast::error_code error, std::size_t) {
          if (error) return;
          if (keep_alive) return self->read();
          self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
        });
  }

  beast::tcp_stream stream_;
  Hub& hub_;
  boost::asio::ip::address peer_;
  beast::flat_buffer buffer_{std::size_t{2} * kMostHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<Answer> answer_;
};

}  // namespace

void serve_http(tcp::socket socket, Hub& hub) {
  std::make_shared<HttpConnection>(std::move(socket), hub)->start();
}

}  // namespace slammot::gateway
