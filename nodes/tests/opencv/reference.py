"""Images and blobs of OpenCV for tests/opencv/main.rs: of the file `image` in a folder, with its width and height."""
import pathlib
import sys

import cv2
import numpy

MORPHOLOGY = {"erode": cv2.MORPH_ERODE, "dilate": cv2.MORPH_DILATE, "open": cv2.MORPH_OPEN, "close": cv2.MORPH_CLOSE}


def threshold(image, radius, offset, dark):
    kind, c = (cv2.THRESH_BINARY_INV, offset) if dark else (cv2.THRESH_BINARY, 1 - offset)
    return cv2.adaptiveThreshold(image, 255, cv2.ADAPTIVE_THRESH_MEAN_C, kind, 2 * radius + 1, c)


def morphology(image, name, radius):
    return cv2.morphologyEx(image, MORPHOLOGY[name], numpy.ones((2 * radius + 1, 2 * radius + 1), numpy.uint8))


def edges(image, high, low):
    blurred = cv2.GaussianBlur(image, (7, 7), 1.4, borderType=cv2.BORDER_REPLICATE)
    return cv2.Canny(blurred, low, high, L2gradient=True)


folder, width, height = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
image = numpy.fromfile(folder / "image", numpy.uint8).reshape(height, width)
for radius in [1, 7, 15, 60]:
    threshold(image, radius, 10, True).tofile(folder / f"dark_{radius}")
    threshold(image, radius, 10, False).tofile(folder / f"light_{radius}")
    for name in MORPHOLOGY:
        morphology(image, name, radius).tofile(folder / f"{name}_{radius}")
for high, low in [(150, 60), (40, 40), (700.5, 20.5)]:
    edges(image, high, low).tofile(folder / f"edges_{high}_{low}")
binary = morphology(threshold(image, 15, 10, True), "open", 1)
_, _, stats, centres = cv2.connectedComponentsWithStats(binary, connectivity=8)
lines = [" ".join(map(str, [*stat, *centre])) for stat, centre in zip(stats[1:], centres[1:])]
(folder / "blobs").write_text("\n".join(lines) + ("\n" if lines else ""))
