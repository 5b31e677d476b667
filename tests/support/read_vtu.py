#!/usr/bin/env python3
"""What a VTU file holds, read with Python's standard library alone, without a line of the program
or of VTK: one line for each name, with its volume or area.

    read_vtu.py FILE
"""
import base64
import re
import struct
import sys
import xml.etree.ElementTree as xml
import zlib

CODES = {"Float64": "d", "Float32": "f", "Int32": "i", "Int64": "q", "UInt8": "B", "Int8": "b",
         "String": "B"}
TRIANGLE, TETRAHEDRON = 5, 10


class Vtu:
    def __init__(self, path):
        with open(path, "rb") as file:
            raw = file.read()
        # Raw bytes are no XML: they are taken out before it is parsed.
        head = re.search(rb'<AppendedData\s+encoding="raw"\s*>\s*_', raw)
        self.appended = b""
        if head:
            end = raw.rindex(b"</AppendedData>")
            self.appended = raw[head.end():end]
            raw = raw[:head.end()] + raw[end:]
        root = xml.fromstring(raw)
        assert root.get("type") == "UnstructuredGrid" and root.get("byte_order") == "LittleEndian"
        assert root.get("compressor") in (None, "vtkZLibDataCompressor")
        self.packed = root.get("compressor") is not None
        self.word = "<Q" if root.get("header_type") == "UInt64" else "<I"
        grid = root.find("UnstructuredGrid")
        pieces = grid.findall("Piece")
        assert len(pieces) == 1
        self.piece = pieces[0]
        self.fields = grid.find("FieldData")

    def numbers(self, section, name):
        parent = self.fields if section == "FieldData" else self.piece.find(section)
        for array in list(parent if parent is not None else []):
            if array.get("Name") == name:
                code = CODES[array.get("type")]
                data = self.bytes_of(array)
                values = struct.unpack("<%d%s" % (len(data) // struct.calcsize(code), code), data)
                components = int(array.get("NumberOfComponents", "1"))
                if components == 1:
                    return values
                return [values[i:i + components] for i in range(0, len(values), components)]
        return None

    def strings(self, name):
        codes = self.numbers("FieldData", name)
        return [] if codes is None else bytes(codes).split(b"\0")[:-1]

    def bytes_of(self, array):
        size = struct.calcsize(self.word)
        if array.get("format") == "appended":
            data = self.appended[int(array.get("offset")):]
        else:
            assert array.get("format") == "binary"
            data = base64.b64decode(array.text.strip())
        words = lambda at, n: struct.unpack_from("<%d%s" % (n, self.word[1]), data, at)
        if not self.packed:
            return data[size:size + words(0, 1)[0]]
        count, length, last = words(0, 3)
        at, out = size * (3 + count), b""
        for k, packed in enumerate(words(3 * size, count)):
            block = zlib.decompress(data[at:at + packed])
            assert len(block) == (last if k + 1 == count and last else length)
            out += block
            at += packed
        return out


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def main(path):
    file = Vtu(path)
    points = file.numbers("Points", "Points") or file.numbers("Points", "points")
    assert len(points) == int(file.piece.get("NumberOfPoints"))
    ids = file.numbers("Cells", "connectivity")
    ends = file.numbers("Cells", "offsets")
    types = file.numbers("Cells", "types")
    assert len(ends) == len(types) == int(file.piece.get("NumberOfCells"))
    body = file.numbers("CellData", "body")
    group = file.numbers("CellData", "group")
    bodies, groups = file.strings("body_names"), file.strings("group_names")
    ratios = [file.numbers("CellData", "filling " + name.decode()) for name in bodies]
    volumes, areas, filled = [0.0] * len(bodies), [0.0] * len(groups), [0.0] * len(bodies)
    counts = {TRIANGLE: 0, TETRAHEDRON: 0}
    begin = 0
    for cell, (end, kind) in enumerate(zip(ends, types)):
        corner = [points[i] for i in ids[begin:end]]
        begin = end
        counts[kind] += 1
        normal = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]))
        if kind == TETRAHEDRON:
            volume = dot(normal, minus(corner[3], corner[0])) / 6
            volumes[body[cell]] += volume
            assert group[cell] == -1
            for b, ratio in enumerate(ratios):
                filled[b] += volume * ratio[cell] if ratio else 0
        else:
            assert body[cell] == -1
            areas[group[cell]] += dot(normal, normal) ** 0.5 / 2
    print("points", len(points))
    print("tetrahedra", counts[TETRAHEDRON])
    print("triangles", counts[TRIANGLE])
    print("unit", file.strings("unit")[0].decode())
    for name, volume in zip(bodies, volumes):
        print("volume %.17g %s" % (volume, name.decode()))
    for name, area in zip(groups, areas):
        print("area %.17g %s" % (area, name.decode()))
    for name, ratio, volume in zip(bodies, ratios, filled):
        if ratio:
            print("filled %.17g %s" % (volume, name.decode()))
    metric = file.numbers("PointData", "metric")
    if metric:
        tensors = file.piece.find("PointData").get("Tensors")
        for k, name in enumerate(("XX", "YY", "ZZ", "XY", "YZ", "XZ")):
            print("%s %s %.17g" % (tensors, name, sum(tensor[k] for tensor in metric)))


main(sys.argv[1])
