"""Images and blobs of OpenCV for tests/opencv/main.rs: of the file `image` in a folder, with its width and height.

With the argument `time` it prints how long OpenCV takes on one thread.
"""
import pathlib
import sys
import time

import cv2
import numpy

MORPHOLOGY = {"erode": cv2.MORPH_ERODE, "dilate": cv2.MORPH_DILATE, "open": cv2.MORPH_OPEN, "close": cv2.MORPH_CLOSE}


def threshold(image, radius, offset, dark):
    kind, c = (cv2.THRESH_BINARY_INV, offset) if dark else (cv2.THRESH_BINARY, 1 - offset)
    return cv2.adaptiveThreshold(image, 255, cv2.ADAPTIVE_THRESH_MEAN_C, kind, 2 * radius + 1, c)


def morphology(image, name, radius):
    return cv2.morphologyEx(image, MORPHOLOGY[name], numpy.ones((2 * radius + 1, 2 * radius + 1), numpy.uint8))


def least(name, radius, act):
    times = []
    for _ in range(200):
        start = time.perf_counter()
        act()
        times.append(time.perf_counter() - start)
    print(f"OpenCV {name:13} {radius:<8} {min(times) * 1e6:6.0f} µs")


cv2.setNumThreads(1)
if sys.argv[1] == "time":
    noise = numpy.random.default_rng(1).integers(0, 256, (480, 640), dtype=numpy.uint8)
    for radius in [1, 7, 15, 60]:
        least("threshold", radius, lambda: threshold(noise, radius, 10, True))
        least("erode", radius, lambda: morphology(noise, "erode", radius))
        least("open", radius, lambda: morphology(noise, "open", radius))
    sys.exit()

folder, width, height = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
image = numpy.fromfile(folder / "image", numpy.uint8).reshape(height, width)
for radius in [1, 7, 15, 60]:
    threshold(image, radius, 10, True).tofile(folder / f"dark_{radius}")
    threshold(image, radius, 10, False).tofile(folder / f"light_{radius}")
    for name in MORPHOLOGY:
        morphology(image, name, radius).tofile(folder / f"{name}_{radius}")
binary = morphology(threshold(image, 15, 10, True), "open", 1)
_, _, stats, centres = cv2.connectedComponentsWithStats(binary, connectivity=8)
lines = [" ".join(map(str, [*stat, *centre])) for stat, centre in zip(stats[1:], centres[1:])]
(folder / "blobs").write_text("\n".join(lines) + ("\n" if lines else ""))
