"""Kernels of other libraries for examples/kernels/main.rs, with the inputs in a folder.

A line with the name of a kernel is answered by its thread CPU time per call in ns and a 0, or by `skipped`.
"""
import pathlib
import sys
import time

import cv2
import numpy
import simplejpeg
import small_gicp
import zxingcpp
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

FORMATS = [zxingcpp.BarcodeFormat.Code128, zxingcpp.BarcodeFormat.Code39, zxingcpp.BarcodeFormat.EAN13,
           zxingcpp.BarcodeFormat.EAN8, zxingcpp.BarcodeFormat.ITF]

folder, span = pathlib.Path(sys.argv[1]), float(sys.argv[2])
cv2.setNumThreads(1)


def image(name):
    width, height = map(int, (folder / f"{name}.size").read_text().split())
    return numpy.fromfile(folder / name, numpy.uint8).reshape(height, width)


def canny(image):
    blurred = cv2.GaussianBlur(image, (7, 7), 1.4, borderType=cv2.BORDER_REPLICATE)
    return cv2.Canny(blurred, 60, 150, L2gradient=True)


def morphology(name, kind, radius):
    square = numpy.ones((2 * radius + 1, 2 * radius + 1), numpy.uint8)
    pixels = image(name)
    return lambda: cv2.morphologyEx(pixels, kind, square)


def hog():
    crop, describe = image("large")[190:290, 310 - 25:310 + 25], cv2.HOGDescriptor((32, 64), (16, 16), (8, 8), (8, 8), 9)
    return lambda: describe.compute(cv2.resize(crop, (32, 64), interpolation=cv2.INTER_AREA))


def points(name):
    return numpy.fromfile(folder / name, numpy.float32).reshape(-1, 3).astype(numpy.float64)


def voxels(cloud):
    return lambda: small_gicp.voxelgrid_sampling(cloud, 0.2)


def clusters(means):
    def find():
        pairs = cKDTree(means).query_pairs(0.35, output_type="ndarray")
        graph = coo_array((numpy.ones(len(pairs), bool), pairs.T), (len(means), len(means)))
        return connected_components(graph, directed=False)
    return find


def act(kernel):
    name, _, word = kernel.rpartition(" ")
    if name == "canny":
        pixels = image(word)
        return lambda: canny(pixels)
    morphologies = {"erode": cv2.MORPH_ERODE, "open": cv2.MORPH_OPEN, "close": cv2.MORPH_CLOSE,
                    "black hat": cv2.MORPH_BLACKHAT}
    if name in morphologies:
        return morphology("large", morphologies[name], int(word))
    if name == "adaptive threshold":
        pixels, mean = image("large"), cv2.ADAPTIVE_THRESH_MEAN_C
        return lambda: cv2.adaptiveThreshold(pixels, 255, mean, cv2.THRESH_BINARY_INV, 2 * int(word) + 1, 10)
    if kernel == "components":
        pixels = image("large_binary")
        return lambda: cv2.connectedComponentsWithStats(pixels, connectivity=8)
    if name == "hough":
        pixels = image(f"{word}_edges")
        return lambda: cv2.HoughLinesP(pixels, 1, numpy.pi / 180, 50, minLineLength=30, maxLineGap=5)
    if name == "distance":
        pixels = image(f"{word}_binary")
        return lambda: cv2.distanceTransform(pixels, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    if kernel == "hog window":
        return hog()
    if kernel == "gray":
        pixels = numpy.stack([image("large") * factor + offset for factor, offset in [(1, 0), (3, 0), (1, 9)]], axis=2)
        return lambda: cv2.cvtColor(pixels, cv2.COLOR_RGB2GRAY)
    if name == "jpeg":
        data = (folder / f"{word}.jpg").read_bytes()
        return lambda: simplejpeg.decode_jpeg(data, "RGB")
    if kernel.startswith("bar code"):
        pixels = image({"a photo without one": "photo", "none in discs": "large", "Code 128": "code128"}[kernel[10:]])
        return lambda: zxingcpp.read_barcodes(pixels, FORMATS)
    if kernel == "cloud voxels":
        return voxels(points("cloud"))
    if kernel == "cloud clusters":
        return clusters(points("voxels"))
    raise ValueError(kernel)


def measured(act):
    act()
    begin, calls = time.thread_time_ns(), 0
    while True:
        act()
        calls += 1
        spent = time.thread_time_ns() - begin
        if spent > span:
            return spent / calls


for line in sys.stdin:
    try:
        answer = f"{measured(act(line.strip()))} 0"
    except FileNotFoundError:
        answer = "skipped"
    print(answer, flush=True)
