"""The picture of a scenario shows walls, objects and the vehicle's way where they are."""

import pathlib
import struct
import tempfile
import unittest
import zlib

import draw_scenario

WAY = [(0.0, 0.0), (100.0, 0.0)]  # m: with the margin of 35 m the picture is 170 m by 70 m
WIDTH = 340  # pixels: two a metre


def pixel(x, y):
    """Column and row of a place."""
    return int(2 * (x + 35.0)), int(2 * (35.0 - y))


class Picture(unittest.TestCase):
    def drawn(self, walls=(), dots=()):
        return draw_scenario.draw(list(walls), list(dots), WAY, WIDTH)

    def at(self, pixels, x, y):
        column, row = pixel(x, y)
        return pixels[row][column]

    def test_covers_the_way_and_a_margin(self):
        pixels = self.drawn()
        self.assertEqual((WIDTH, 141), (len(pixels[0]), len(pixels)))

    def test_shows_the_way_on_white(self):
        pixels = self.drawn()
        self.assertEqual(draw_scenario.VEHICLE, self.at(pixels, 50.0, 0.0))
        self.assertEqual(0, self.at(pixels, 50.0, 10.0))

    def test_marks_where_the_vehicle_begins(self):
        pixels = self.drawn()
        self.assertEqual(draw_scenario.VEHICLE, self.at(pixels, 0.0, 1.0))
        self.assertEqual(0, self.at(pixels, 100.0, 1.0))

    def test_shows_walls_north_above_the_way(self):
        pixels = self.drawn(walls=[((20.0, 20.0), (40.0, 20.0), 1)])
        self.assertEqual(1, self.at(pixels, 30.0, 20.0))
        self.assertEqual(0, self.at(pixels, 30.0, -20.0))
        self.assertLess(pixel(30.0, 20.0)[1], pixel(30.0, 0.0)[1])

    def test_leaves_out_what_is_beyond_the_margin(self):
        self.assertEqual(self.drawn(), self.drawn(walls=[((0.0, 90.0), (100.0, 90.0), 1)]))


class TruthFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.prefix = str(self.folder / "truth")
        (self.folder / "truth.walls.csv").write_text("ax,ay,bx,by,class\n0,10,100,10,0\n0,-10,5,-10,1\n")
        (self.folder / "truth.objects.csv").write_text(
            "timestamp,id,class,x,y\n1,1,car,10,2\n1,2,bus,20,2\n1,3,bicycle,30,2\n1,4,pedestrian,40,2\n")
        (self.folder / "truth.tum").write_text("1 0 0 0 0 0 0 1\n2 100 0 0 0 0 0 1\n")

    def test_have_a_colour_for_each_class_and_surface(self):
        walls, dots, way = draw_scenario.read(self.prefix)
        self.assertEqual([1, 2], [colour for _, _, colour in walls])
        self.assertEqual([5, 6, 7, 8], [colour for _, _, colour in dots])
        self.assertEqual(WAY, way)

    def test_become_a_picture_that_holds_what_was_drawn(self):
        picture = self.folder / "picture.png"
        draw_scenario.main(["draw_scenario.py", self.prefix, str(picture), str(WIDTH)])
        data = picture.read_bytes()
        self.assertEqual(b"\x89PNG\r\n\x1a\n", data[:8])
        chunks, at = {}, 8
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + length]
            self.assertEqual(zlib.crc32(kind + body), struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0], kind)
            chunks[kind] = body
            at += 12 + length
        self.assertEqual((WIDTH, 141), struct.unpack(">II", chunks[b"IHDR"][:8]))
        rows = zlib.decompress(chunks[b"IDAT"])
        expected = draw_scenario.draw(*draw_scenario.read(self.prefix), WIDTH)
        self.assertEqual(b"".join(b"\0" + bytes(row) for row in expected), rows)


if __name__ == "__main__":
    unittest.main()
