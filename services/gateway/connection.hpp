#pragma once

#include <utility>  // Boost 1.74's asio does not include it in C++20

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "services/gateway/hub.hpp"

namespace slammot::gateway {

/// Serves a connection until its end: answers requests, and hands it over if it asks for a
/// WebSocket.
void serve_http(boost::asio::ip::tcp::socket socket, Hub& hub);

using UpgradeRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Serves a WebSocket until its end. The request was checked.
void serve_websocket(boost::beast::tcp_stream stream, UpgradeRequest request, Hub& hub);

}  // namespace slammot::gateway
