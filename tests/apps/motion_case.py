"""What the tests of `stereomotion analyse` share: turns, noisy poses, C3D files, a case.

Noise is seeded, and bounds are quantiles of χ². Python's standard library is all it takes.
"""

import math
import struct

from small_recording import FolderCase, run

# Exceeded by three standard normal squares once in 100 000 runs; seeds make it once and for all.
CHI2_3 = 25.9
RATE_HZ = 50


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def times(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def turn(v):
    """The rotation by a rotation vector [rad] (Rodrigues)."""
    angle = math.sqrt(sum(x * x for x in v))
    if angle == 0:
        return [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    x, y, z = (c / angle for c in v)
    hat = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    square = product(hat, hat)
    return [[(i == j) + math.sin(angle) * hat[i][j] + (1 - math.cos(angle)) * square[i][j]
             for j in range(3)] for i in range(3)]


def quaternion(r):
    """Of a turn by less than 120°."""
    w = math.sqrt(1 + r[0][0] + r[1][1] + r[2][2]) / 2
    return [w, (r[2][1] - r[1][2]) / (4 * w), (r[0][2] - r[2][0]) / (4 * w),
            (r[1][0] - r[0][1]) / (4 * w)]


def chi2(error, covariance):
    """eᵀ C⁻¹ e of three numbers (Cramer's rule)."""
    a = covariance
    def det(m):
        return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))
    solved = []
    for k in range(3):
        column = [[error[i] if j == k else a[i][j] for j in range(3)] for i in range(3)]
        solved.append(det(column) / det(a))
    return sum(e * s for e, s in zip(error, solved))


def noisy(pose, rng, sigma_rad, sigma_mm):
    """The pose (rotation, translation) with noise of the left perturbation."""
    rotation, translation = pose
    by = turn([rng.gauss(0, sigma_rad) for _ in range(3)])
    return product(by, rotation), [t + rng.gauss(0, sigma_mm) for t in translation]


def about(rotation, center_in_body, place):
    """The pose that holds a body point at a place."""
    moved = times(rotation, center_in_body)
    return rotation, [p - m for p, m in zip(place, moved)]


def poses_csv(poses, sigma_rad=None, sigma_mm=None):
    """Text of poses.csv, with covariances where σ is given; None among the poses is a gap."""
    names = [f'cov_{i}{j}' for i in range(6) for j in range(i, 6)] if sigma_rad else []
    header = ['frame', 'timestamp_ns', 'status', 'qw', 'qx', 'qy', 'qz', 'tx_mm', 'ty_mm', 'tz_mm']
    lines = [','.join(header + names)]
    for i, pose in enumerate(poses):
        cells = [str(i), str(round(1e9 * i / RATE_HZ)), 'lost' if pose is None else 'ok']
        if pose is None:
            lines.append(','.join(cells + [''] * (7 + len(names))))
            continue
        cells += ['%.12g' % x for x in [*quaternion(pose[0]), *pose[1]]]
        for name in names:
            variance = (sigma_rad if name[4] < '3' else sigma_mm) ** 2
            cells.append('%.12g' % variance if name[4] == name[5] else '0')
        lines.append(','.join(cells))
    return '\n'.join(lines) + '\n'


def c3d(labels, frames):
    """Bytes of a C3D file (Intel, floats, mm); None among a frame's points is one not seen."""
    def record(name, group, body):
        return struct.pack('<bb', len(name), group) + name + struct.pack('<H', len(body) + 2) + body

    def parameter(name, kind, dimensions, data):
        sizes = bytes(dimensions)
        return record(name, 1, struct.pack('<bB', kind, len(sizes)) + sizes + data + b'\0')

    width = max(map(len, labels))
    text = ''.join(label.ljust(width) for label in labels).encode()
    section = b'\x01\x50\x01\x54' + record(b'POINT', -1, b'\0')
    section += parameter(b'USED', 2, [], struct.pack('<h', len(labels)))
    section += parameter(b'SCALE', 4, [], struct.pack('<f', -1))
    section += parameter(b'RATE', 4, [], struct.pack('<f', RATE_HZ))
    section += parameter(b'UNITS', -1, [2], b'mm')
    section += parameter(b'LABELS', -1, [width, len(labels)], text) + b'\0\0'
    blocks = -(-len(section) // 512)
    header = b'\x02\x50' + struct.pack('<5H', len(labels), 0, 1, len(frames), 0)
    header += struct.pack('<f2Hf', -1, 2 + blocks, 1, RATE_HZ)
    data = b''.join(struct.pack('<4f', *(point or (0, 0, 0)), 0 if point else -1)
                    for frame in frames for point in frame)
    return header.ljust(512, b'\0') + section.ljust(512 * blocks, b'\0') + data


class MotionCase(FolderCase):
    """The program, run in the folder of the class."""

    @classmethod
    def run_program(cls, *arguments, **options):
        return run(*arguments, cwd=cls.base, timeout=300, **options)

    def analyse(self, *arguments, code=0):
        done = self.run_program('analyse', *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done
