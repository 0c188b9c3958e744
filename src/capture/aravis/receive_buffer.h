#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <string>

namespace stereomotion {

/// So much may wait in the kernel while this program is busy: 0.1 s of 2 × 1.3 Mpx at 60 Hz.
constexpr int kReceiveBuffer_bytes = 16 << 20;

/// Enlarges the receive buffer of the UDP socket that is bound to that address and port, beyond the
/// kernel's limit where this program may (CAP_NET_ADMIN). Returns the bytes that it holds now; 0:
/// no such socket.
///
/// Aravis' own setting waits for the first packet, stops at the limit and does not tell.
std::int64_t EnlargeReceiveBuffer(const sockaddr_in& bound_to);

/// Says what to do where a receive buffer became no larger than `bytes`; empty where that is
/// enough.
std::string ReceiveBufferWarning(const std::string& uri, std::int64_t bytes);

}  // namespace stereomotion
