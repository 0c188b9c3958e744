#!/usr/bin/env python3
"""Prints the poses that `stereomotion track --stream ADDRESS` sends while it measures.

    stereomotion track --left aravis:CAM-1 --right aravis:CAM-2 --body body.yaml \
        --stream tcp://127.0.0.1:5555
    examples/stream_client.py tcp://127.0.0.1:5555

    stereomotion track --recording take.h5 --body body.yaml --stream - | examples/stream_client.py -

A stream is lines of JSON (docs/formats.md, stereomotion-stream/1): a hello, a line a body and frame
pair, an end. Python's standard library is all this needs, but for zmq+tcp:// (python3-zmq).
"""

import argparse
import json
import math
import socket
import sys
import time

FORMAT = "stereomotion-stream/1"


def tcp_lines(host, port, wait_s):
    """Connects, trying again for `wait_s` seconds: the program may be started later."""
    until = time.monotonic() + wait_s
    while True:
        try:
            connection = socket.create_connection((host, port), timeout=wait_s)
            break
        except OSError:
            if time.monotonic() > until:
                raise
            time.sleep(0.1)
    connection.settimeout(None)
    with connection, connection.makefile("r", encoding="utf-8") as stream:
        yield from stream


def udp_lines(host, port, wait_s):
    """Listens; a datagram is a line. Fails where nothing comes for `wait_s` seconds."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_DGRAM) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        listener.bind((host, port))
        listener.settimeout(wait_s)
        while True:
            yield listener.recv(65536).decode("utf-8")


def zmq_lines(endpoint, wait_s):
    import zmq  # pylint: disable=import-outside-toplevel

    with zmq.Context() as context, context.socket(zmq.SUB) as subscriber:
        subscriber.setsockopt(zmq.SUBSCRIBE, b"")
        subscriber.setsockopt(zmq.LINGER, 0)
        subscriber.setsockopt(zmq.RCVTIMEO, int(1000 * wait_s))
        subscriber.connect(endpoint)
        while True:
            try:
                yield subscriber.recv().decode("utf-8")
            except zmq.Again as error:
                raise TimeoutError(f"nothing came from {endpoint}") from error


def lines_of(address, wait_s):
    """Finds the lines of a stream, whatever carries them."""
    if address == "-":
        return iter(sys.stdin)
    kind, _, place = address.partition("://")
    host, _, port = place.rpartition(":")
    if kind in ("tcp", "udp") and port.isdigit():
        reader = tcp_lines if kind == "tcp" else udp_lines
        return reader(host.strip("[]"), int(port), wait_s)
    if kind == "zmq+tcp":
        return zmq_lines("tcp://" + place, wait_s)
    sys.exit(f"{address}: expected -, tcp://HOST:PORT, udp://HOST:PORT or zmq+tcp://HOST:PORT")


def message_of(line):
    try:
        message = json.loads(line)
    except ValueError:
        message = None
    if isinstance(message, dict) and {"format", "body", "end"} & set(message):
        return message
    return sys.exit(f"found {line.strip()[:60]!r}, expected lines of JSON ({FORMAT})")


def messages(address, wait_s=10.0):
    """Yields ("hello" | "pose" | "end", message); ends after the end. A hello may come again."""
    for line in lines_of(address, wait_s):
        message = message_of(line)
        if "format" in message:
            if message["format"] != FORMAT:
                sys.exit(f"found a stream of format {message['format']}, expected {FORMAT}")
            yield "hello", message
        elif "end" in message:
            yield "end", message
            return
        else:
            yield "pose", message


def position_sigma_mm(covariance):
    """The three standard deviations of t: `cov` is the upper triangle of 6 x 6, row by row."""
    return [math.sqrt(max(0.0, covariance[index])) for index in (15, 18, 20)]


def text_of(pose):
    start = f"{pose['frame']:8d} {pose['timestamp_ns'] * 1e-9:14.6f} s  {pose['body']:12s} "
    if pose["status"] != "ok":
        return start + pose["status"]
    x, y, z = pose["t_mm"]
    sigma = max(position_sigma_mm(pose["cov"]))
    latency = f"  {pose['latency_ms']:.1f} ms" if "latency_ms" in pose else ""
    return f"{start}{x:10.3f} {y:10.3f} {z:10.3f} mm  +- {sigma:.4f}{latency}"


def parse_arguments():
    parser = argparse.ArgumentParser(
        description="Prints the poses of `stereomotion track --stream ADDRESS`.")
    parser.add_argument("address", help="-, tcp://HOST:PORT, udp://HOST:PORT, zmq+tcp://HOST:PORT")
    parser.add_argument("--body", help="only this body")
    parser.add_argument("--json", action="store_true", help="print the lines as they came")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="print every Nth pose")
    parser.add_argument("--wait-s", type=float, default=10.0,
                        help="so long the program is waited for (default: 10)")
    arguments = parser.parse_args()
    if arguments.every < 1:
        parser.error(f"--every: found {arguments.every}, expected 1 or more")
    return arguments


def show(kind, message, as_json):
    if as_json:
        text = json.dumps(message)
    elif kind == "hello":
        text = "# bodies: " + ", ".join(message["bodies"])
    elif kind == "end":
        text = f"# end: {message['end']}, {message['pairs']} pairs"
    else:
        text = text_of(message)
    print(text, flush=True)


def main():
    arguments = parse_arguments()
    poses = hellos = 0
    for kind, message in messages(arguments.address, arguments.wait_s):
        if kind == "hello":
            hellos += 1
            if hellos > 1:
                continue
        if kind == "pose":
            if arguments.body not in (None, message["body"]):
                continue
            poses += 1
            if (poses - 1) % arguments.every:
                continue
        show(kind, message, arguments.json)
        if kind == "end":
            return 0
    print("# the stream broke off", file=sys.stderr)
    return 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (KeyboardInterrupt, BrokenPipeError):
        sys.exit(0)
    except (OSError, UnicodeDecodeError) as problem:
        sys.exit(f"stream_client: {problem}")
