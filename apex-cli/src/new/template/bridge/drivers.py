"""Drivers of a base and a laser scanner, in a simulated room: the other side of the bridge in src/lib.rs."""
import math
import socket
import time

MISSION, HERE = ("127.0.0.1", 7500), ("127.0.0.1", 7501)
PERIOD, TIMEOUT, WALL, BEAMS = 0.05, 0.5, 3.0, 90  # s, s, m

link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.bind(HERE)
link.setblocking(False)
x = y = theta = speed = omega = 0.0
heard = now = time.monotonic()
while True:
    time.sleep(PERIOD)
    before, now = now, time.monotonic()
    try:
        while True:
            word, *numbers = link.recv(1024).decode().split()
            if word == "twist":
                speed, _, omega = map(float, numbers)
                heard = now
    except BlockingIOError:
        pass  # All datagrams are read.
    if now - heard > TIMEOUT:  # The mission is silent: a base that goes on would not stop for anything.
        speed = omega = 0.0
    theta += omega * (now - before)
    x, y = x + speed * math.cos(theta) * (now - before), y + speed * math.sin(theta) * (now - before)
    step, ranges = math.tau / BEAMS, []
    for beam in range(BEAMS):
        c, s = math.cos(theta - math.pi + beam * step), math.sin(theta - math.pi + beam * step)
        to_walls = (math.copysign(WALL, c) - x) / c if c else math.inf, (math.copysign(WALL, s) - y) / s if s else math.inf
        ranges.append(f"{min(to_walls):.3f}")
    link.sendto(f"odometry {x} {y} {theta}".encode(), MISSION)
    link.sendto(f"scan {-math.pi} {step} 0.05 20 {' '.join(ranges)}".encode(), MISSION)
    print(f"x = {x:.2f} m, {speed:.2f} m/s", flush=True)
