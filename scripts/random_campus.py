# SPDX-License-Identifier: BSD-3-Clause
# World files of random streets, in the manner of config/worlds/campus.yaml, with a robot that looks
# at them from many places: what scripts/train-network learns from. See docs/simulator.md.
import json
import math
import random


class Frame:
    """A place and a heading in the world; puts solids there. Metres, degrees."""

    def __init__(self, solids, x=0.0, y=0.0, yaw=0.0):
        self.solids, self.x, self.y, self.yaw = solids, x, y, yaw

    def world(self, x, y):
        c, s = math.cos(math.radians(self.yaw)), math.sin(math.radians(self.yaw))
        return [round(self.x + c * x - s * y, 3), round(self.y + s * x + c * y, 3)]

    def at(self, x, y, yaw=0.0):
        return Frame(self.solids, *self.world(x, y), self.yaw + yaw)

    def put(self, shape, class_name, x, y, z, color=None, **keys):
        solid = {"shape": shape, "class": class_name, "center": self.world(x, y) + [round(z, 3)]}
        for key, value in keys.items():
            solid[key] = [round(v, 3) for v in value] if key == "size" else round(value, 3)
        if shape in ("box", "ground"):
            solid["yaw_deg"] = round(self.yaw, 3)
        if color is not None:
            solid["color"] = [min(255, max(0, round(c))) for c in color]
        self.solids.append(solid)

    def box(self, class_name, x, y, base, size, color=None):
        self.put("box", class_name, x, y, base + size[2] / 2, color, size=size)

    def ground(self, class_name, x0, x1, y0, y1, z, color=None):
        if x1 - x0 > 0.1 and y1 - y0 > 0.1:
            self.put("ground", class_name, (x0 + x1) / 2, (y0 + y1) / 2, z, color,
                     size=[x1 - x0, y1 - y0])

    def cylinder(self, class_name, x, y, base, radius, height, color=None):
        self.put("cylinder", class_name, x, y, base + height / 2, color,
                 radius=radius, height=height)

    def sphere(self, class_name, x, y, z, radius, color=None):
        self.put("sphere", class_name, x, y, z, color, radius=radius)


class Campus:
    """A street along x, perhaps with a street across; `random` decides on everything else."""

    KERB = 0.05  # height of sidewalks and lawns; the road lies at −0.05

    def __init__(self, rng):
        self.random = rng
        self.solids = []
        self.obstacles = []  # (x, y, radius) on the road, where no robot can be
        self.root = Frame(self.solids, 0, 0, rng.uniform(0, 360))
        self.road_color = self.near((88, 88, 94), 12)
        self.sidewalk_color = self.near((178, 172, 162), 14)
        self.lawn_color = self.near((118, 160, 78), 14)
        self.half_road = rng.uniform(2.8, 4.5)
        self.half_cross = rng.uniform(2.8, 4.5)
        self.reach = rng.uniform(40, 70)
        self.crossing = rng.uniform(-15, 25)
        # Which sides the crossing street leads to; it comes after the main street's sidewalks.
        self.cross_sides = rng.choice([(), (1,), (-1,), (1, -1), (1,), (-1,)])
        self.lay_streets()
        for side in (1, -1):
            self.furnish_side(side)

    # --- colours ---------------------------------------------------------------------------------

    def near(self, color, spread):
        shift = self.random.uniform(-spread, spread)
        return [c + shift + self.random.uniform(-spread, spread) / 3 for c in color]

    def any_color(self, low=25, high=235):
        return [self.random.uniform(low, high) for _ in range(3)]

    def facade_color(self):
        """Brick, sandstone, plaster or concrete."""
        brick, stone = (195, 125, 98), (210, 175, 125)
        plaster, concrete = (205, 190, 150), (168, 176, 190)
        return self.near(self.random.choice([brick, stone, plaster, concrete]), 25)

    # --- ground ----------------------------------------------------------------------------------

    def lay_streets(self):
        reach, half = self.reach, self.half_road
        self.root.ground("road", -reach, reach, -half, half, -self.KERB, self.road_color)
        for side in self.cross_sides:
            street = self.root.at(self.crossing, side * half, 90 * side)
            street.ground("road", 0, 50, -self.half_cross, self.half_cross, -self.KERB,
                          self.road_color)
        for _ in range(self.random.choice([0, 1, 1, 2])):
            self.zebra(self.random.uniform(-reach / 2, reach / 2))

    def zebra(self, x):
        color = self.near((228, 228, 228), 18)
        length, width = self.random.uniform(2, 4), self.random.uniform(0.4, 0.7)
        y = -self.half_road + width
        while y < self.half_road - 0.3:
            self.root.ground("road", x, x + length, y - width / 2, y + width / 2, -self.KERB, color)
            y += 2.1 * width

    def furnish_side(self, side):
        """The blocks beside the main street, and their other front at the street across."""
        half, depth = self.half_road, 45
        walk = self.random.uniform(2, 4)
        # x runs along the kerb and y away from the road, in both frames.
        if side not in self.cross_sides:
            self.block(self.root.at(-side * self.reach, side * half, 0 if side > 0 else 180),
                       2 * self.reach, depth, walk)
            return
        edges = [(-self.reach, self.crossing - self.half_cross),
                 (self.crossing + self.half_cross, self.reach)]
        for near_end, far_end in edges:
            length = far_end - near_end
            start = near_end if side > 0 else far_end
            block = self.root.at(start, side * half, 0 if side > 0 else 180)
            ends_at_crossing = (far_end < self.crossing) == (side > 0)
            self.block(block, length, depth, walk, "end" if ends_at_crossing else "start")

    def block(self, frame, length, depth, walk, corner=None):
        # Lawns end under the sidewalks: no green kerbs.
        frame.ground("terrain", walk / 2 if corner == "start" else 0,
                     length - walk / 2 if corner == "end" else length,
                     walk / 2, depth, self.KERB, self.lawn_color)
        frame.ground("sidewalk", 0, length, 0, walk, self.KERB, self.sidewalk_color)
        start, end = 2.0, length - 2
        if corner:
            start, end = (12.0, end) if corner == "start" else (start, length - 12)
            across = (frame.at(0, depth, -90) if corner == "start" else frame.at(length, 0, 90))
            across.ground("sidewalk", 0, depth, 0, walk, self.KERB, self.sidewalk_color)
            first, last = (2.0, depth - 12) if corner == "start" else (12.0, depth - 2)
            self.kerbside(across, first, last, walk)
            self.lots(across, first, last, walk, depth_limit=9)
        self.kerbside(frame, start, end, walk)
        self.lots(frame, start, end, walk, depth_limit=14)

    # --- what stands at the kerb -----------------------------------------------------------------

    def kerbside(self, frame, start, end, walk):
        self.every(frame, start, end, (11, 26), lambda x: self.lamp(frame, x, walk))
        self.every(frame, start, end, (14, 50), lambda x: self.sign(frame, x))
        self.every(frame, start, end, (5, 16), lambda x: self.person(frame, x, walk))
        self.every(frame, start, end, (8, 30), lambda x: self.street_clutter(frame, x, walk))
        if self.random.random() < 0.75:
            self.every(frame, start + 3, end - 3, (5.2, 18), lambda x: self.car(frame, x))

    def every(self, frame, start, end, gaps, place):
        x = start + self.random.uniform(0, gaps[1])
        while x < end:
            place(x)
            x += self.random.uniform(*gaps)

    def lamp(self, frame, x, walk):
        color = self.near((70, 70, 90), 10)
        height, radius = self.random.uniform(4.3, 6.2), self.random.uniform(0.06, 0.12)
        y = self.random.uniform(0.3, min(1.2, walk - 0.4))
        arm = self.random.uniform(1.0, 2.0)
        frame.cylinder("pole", x, y, self.KERB, radius, height, color)
        frame.box("pole", x, y - arm / 2, height, [0.2, arm, 0.14], color)

    def sign(self, frame, x):
        height, edge = self.random.uniform(2.1, 3.0), self.random.uniform(0.5, 0.8)
        y = self.random.uniform(0.2, 0.6)
        turned = frame.at(x, y, self.random.uniform(-12, 12))
        turned.cylinder("pole", 0, 0, self.KERB, self.random.uniform(0.045, 0.075), height,
                        self.near((70, 70, 90), 10))
        facing = self.random.choice([-0.09, 0.09])
        turned.box("traffic-sign", facing, 0, height - edge + 0.25, [0.06, edge, edge],
                   self.near((250, 200, 0), 15))

    def person(self, frame, x, walk, y=None):
        y = self.random.uniform(0.4, walk + 0.6) if y is None else y
        height = self.random.uniform(1.35, 1.75)
        frame.cylinder("person", x, y, self.KERB - 0.1, self.random.uniform(0.19, 0.27), height,
                       self.any_color(50, 235))
        frame.sphere("person", x, y, height + 0.06, 0.14, self.near((225, 180, 150), 18))
        self.avoid(frame, x, y, 1.0)

    def street_clutter(self, frame, x, walk):
        kind = self.random.random()
        y = self.random.uniform(0.4, walk)
        if kind < 0.55:  # a bin
            frame.cylinder("clutter", x, y, self.KERB, self.random.uniform(0.2, 0.32),
                           self.random.uniform(0.75, 1.1), self.near((70, 80, 75), 15))
        elif kind < 0.85:
            self.bench(frame.at(x, y))
        else:  # a news stand
            frame.box("clutter", x, walk - 0.6, self.KERB,
                      [self.random.uniform(1.2, 2.2), 1, self.random.uniform(1.8, 2.5)],
                      self.near(self.random.choice([(60, 110, 90), (80, 95, 120)]), 20))

    def bench(self, frame):
        frame.box("clutter", 0, 0, self.KERB, [1.7, 0.5, self.random.uniform(0.45, 0.7)],
                  self.near((140, 95, 55), 15))

    def car(self, frame, x):
        flip = self.random.choice([0, 180])
        car = frame.at(x, -self.random.uniform(1.0, 1.35), flip + self.random.uniform(-3, 3))
        length, width = self.random.uniform(3.6, 4.7), self.random.uniform(1.6, 1.85)
        gray = self.random.uniform(30, 230)
        paint = self.near([gray] * 3, 8) if self.random.random() < 0.45 else self.any_color()
        base, body = -self.KERB + 0.17, self.random.uniform(0.65, 0.85)
        car.box("car", 0, 0, base, [length, width, body], paint)
        car.box("car", self.random.uniform(-0.4, 0.1), 0, base + body,
                [length * self.random.uniform(0.48, 0.6), width - 0.2,
                 self.random.uniform(0.48, 0.62)], [0.6 * c + 20 for c in paint])
        self.avoid(car, 0, 0, 3.2)

    # --- what stands behind the sidewalk ---------------------------------------------------------

    def lots(self, frame, start, end, walk, depth_limit):
        x = start
        while x < end - 8:
            width = min(self.random.uniform(9, 24), end - x)
            lot = frame.at(x, walk)
            kind = self.random.random()
            if kind < 0.6:
                self.building_lot(lot, width, depth_limit)
            elif kind < 0.9:
                self.park(lot, width)
            x += width + self.random.uniform(0.5, 4)

    def building_lot(self, lot, width, depth_limit):
        set_back = self.random.choice([self.random.uniform(1.2, 4), self.random.uniform(4, 14)])
        self.border(lot, width, self.random.uniform(0.5, 1.1))
        if set_back > 4.5:
            for _ in range(self.random.randint(0, 3)):
                self.tree(lot, self.random.uniform(1.5, width - 1.5),
                          self.random.uniform(2, set_back - 2))
        depth, height = self.random.uniform(5, depth_limit), self.random.uniform(3.2, 9)
        color, middle = self.facade_color(), width / 2
        lot.box("building", middle, set_back + depth / 2, 0, [width - 1, depth, height], color)
        if self.random.random() < 0.3:  # an upper floor that stands back
            lot.box("building", middle, set_back + depth / 2, height,
                    [0.65 * width, 0.65 * depth, self.random.uniform(2, 3)],
                    [c - 18 for c in color])
        if self.random.random() < 0.25:  # a wing
            lot.box("building", self.random.choice([3, width - 3]), set_back + depth / 2, 0,
                    [5, depth + 2, 0.75 * height], [c - 12 for c in color])
        self.entrance(lot, middle + self.random.uniform(-width / 4, width / 4), set_back)

    def entrance(self, lot, x, set_back):
        if self.random.random() < 0.7:
            lot.ground("sidewalk", x - 1.2, x + 1.2, 0, set_back, self.KERB, self.sidewalk_color)
        ornament = self.random.random()
        if ornament < 0.25:  # a canopy
            lot.box("building", x, set_back - 0.6, self.random.uniform(2.5, 3),
                    [self.random.uniform(3, 8), 1.2, 0.2], self.any_color(50, 200))
        elif ornament < 0.45:  # a portico
            color = self.near((228, 210, 182), 15)
            lot.box("sidewalk", x, set_back - 0.6, 0, [8, 1.6, 0.25], self.sidewalk_color)
            for column in (-3.4, -1.4, 1.4, 3.4):
                lot.cylinder("building", x + column, set_back - 0.5, 0.2, 0.28, 3, color)
            lot.box("building", x, set_back - 0.5, 3.1, [7.5, 0.8, 1.3], color)
        lot.box("door", x, set_back, self.KERB,
                [self.random.uniform(1.1, 2), 0.12, self.random.uniform(2.1, 2.6)],
                self.near((160, 90, 40), 12))

    def park(self, lot, width):
        self.border(lot, width, self.random.uniform(0.5, 1.1))
        depth = self.random.uniform(12, 28)
        if self.random.random() < 0.6:
            path = lot.at(self.random.uniform(3, width - 3), 0, self.random.uniform(-40, 40))
            path.ground("sidewalk", -1.2, 1.2, 0, depth, self.KERB, self.sidewalk_color)
        if self.random.random() < 0.3:
            self.fountain(lot, width / 2, depth / 2)
        for _ in range(self.random.randint(1, 6)):
            self.tree(lot, self.random.uniform(1, width - 1), self.random.uniform(2, depth))
        for _ in range(self.random.randint(0, 2)):
            self.bench(lot.at(self.random.uniform(2, width - 2), self.random.uniform(2, depth),
                              self.random.uniform(0, 180)))
        for _ in range(self.random.randint(0, 2)):
            self.person(lot, self.random.uniform(2, width - 2), 0,
                        y=self.random.uniform(1.5, depth))

    def border(self, lot, width, y):
        kind = self.random.random()
        start, end = 0.4, width * self.random.uniform(0.3, 0.98)
        if kind < 0.3:
            lot.box("vegetation", (start + end) / 2, y, -0.05,
                    [end - start, 0.7, self.random.uniform(0.8, 1.4)],
                    self.near((35, 142, 35), 12))
        elif kind < 0.65:
            color, height = self.near((190, 153, 153), 10), self.random.uniform(1.2, 1.8)
            lot.box("fence", (start + end) / 2, y, -0.05, [end - start, 0.06, height], color)
            for post in range(int((end - start) / 3) + 1):
                lot.cylinder("fence", start + 3 * post, y, -0.05, 0.07, height + 0.2, color)

    def tree(self, frame, x, y):
        height, radius = self.random.uniform(2.2, 3.2), self.random.uniform(1.0, 1.9)
        shade = self.random.uniform(-8, 12)
        leaves = (45 + shade, 130 + 2 * shade, 50)
        frame.cylinder("trunk", x, y, -0.05, self.random.uniform(0.13, 0.25), height,
                       self.near((135, 80, 30), 10))
        frame.sphere("vegetation", x, y, height + 0.7 * radius, radius, leaves)
        for angle in (self.random.uniform(0, 180), self.random.uniform(180, 360)):
            dx, dy = 0.8 * math.cos(math.radians(angle)), 0.8 * math.sin(math.radians(angle))
            frame.sphere("vegetation", x + dx, y + dy,
                         height + self.random.uniform(0.3, 0.7) * radius, 0.72 * radius,
                         [c + 8 for c in leaves])

    def fountain(self, frame, x, y):
        color, radius = self.near((150, 160, 170), 12), self.random.uniform(1.4, 2.6)
        frame.cylinder("clutter", x, y, -0.05, radius, 0.6, color)
        frame.cylinder("clutter", x, y, -0.05, 0.4, 1.7, color)

    # --- the robot -------------------------------------------------------------------------------

    def avoid(self, frame, x, y, radius):
        self.obstacles.append((*frame.world(x, y), radius))

    def is_free(self, x, y):
        return all(math.hypot(x - ox, y - oy) > r for ox, oy, r in self.obstacles)

    def station(self):
        """[x, y, yaw] on a street: along it for the most part, sometimes as in a turn."""
        while True:
            if self.cross_sides and self.random.random() < 0.4:
                side = self.random.choice(self.cross_sides)
                street = self.root.at(self.crossing, side * self.half_road, 90 * side)
                length, half = (-2, 40), self.half_cross
            else:
                street, half = self.root, self.half_road
                length = (-0.9 * self.reach, 0.9 * self.reach)
            place = street.world(self.random.uniform(*length),
                                 self.random.uniform(-1, 1) * (half - 0.6))
            turn = self.random.choice([self.random.gauss(0, 4), self.random.gauss(0, 4),
                                       self.random.uniform(-60, 60)])
            if self.is_free(*place):
                heading = street.yaw + self.random.choice([0, 180]) + turn
                return place + [round(heading, 3)]


def random_world(seed, stations, label_set):
    """The text of a world file. Equal arguments give equal worlds."""
    rng = random.Random(seed)
    campus = Campus(rng)
    camera = {
        "type": "camera", "label": "camera", "rate": 1, "width": 320, "height": 240,
        "pose": [0.3, 0, round(rng.uniform(1.3, 1.75), 3), 0, round(rng.uniform(0, 8), 3), 0],
        "horizontal_fov_deg": round(rng.uniform(80, 100), 3)}
    world = {
        "label_set": label_set, "seed": seed,
        "truth": {"resolution": 0.1, "min": [0, 0, 0], "max": [1, 1, 1]},
        "robot": {"stations": [campus.station() for _ in range(stations)], "dwell": 1},
        "sensors": [camera],
        "solids": campus.solids}
    return json.dumps(world)  # JSON is YAML
