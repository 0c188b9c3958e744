#!/usr/bin/env python3
"""Runs `analyse` on poses and markers of other programs.

Usage: analyse_foreign_test.py PATH/TO/stereomotion [unittest options]
"""

import json
import math
import random
import struct

from motion_case import CHI2_3, MotionCase, about, c3d, chi2, noisy, poses_csv, times, turn
from small_recording import main, rows

CENTER_MM, PLACE_MM = (10, 20, 30), (100, 100, 100)
SIGMA_RAD, SIGMA_MM = 0.001, 0.05
MARKERS_MM = ((0, 0, 0), (120, 0, 10), (0, 90, -20), (60, 50, 80))


def true_poses(count):
    """About a point at rest, 40° about an axis that itself turns."""
    turns = [turn([0.35 * math.sin(0.13 * i), 0.35 * math.cos(0.13 * i), 0.01 * i])
             for i in range(count)]
    return [about(rotation, CENTER_MM, PLACE_MM) for rotation in turns]


def pivot_poses(count=60):
    rng = random.Random(5)
    return [noisy(pose, rng, SIGMA_RAD, SIGMA_MM) for pose in true_poses(count)]


def seen_markers(pose, rng, sigma_mm=0.1):
    rotation, translation = pose
    return [[t + x + rng.gauss(0, sigma_mm) for t, x in zip(translation, times(rotation, marker))]
            for marker in MARKERS_MM]


class Foreign(MotionCase):
    def center(self, folder):
        motion = json.loads((self.base / folder / 'motion.json').read_text(encoding='utf-8'))
        return motion['spin_center']

    def expect_center(self, spin, largest_u_mm):
        self.assertEqual(spin['law'], 'fixed')
        error = [a - b for a, b in zip(spin['in_world_mm'], PLACE_MM)]
        self.assertLess(chi2(error, spin['in_world_covariance_mm2']), CHI2_3)
        for k in range(3):
            self.assertLess(math.sqrt(spin['covariance_mm2'][k][k]), largest_u_mm)

    # The centre's bound for N poses: about σ √(1 + (|c| σ_R / σ)²) / (√N · spread of the turns).
    def test_poses_without_covariance(self):
        (self.base / 'pivot.csv').write_text(poses_csv(pivot_poses()), encoding='utf-8')
        done = self.analyse('pivot.csv')
        self.assertIn('carry no covariance', done.stderr)
        spin = self.center('pivot-motion')
        self.expect_center(spin, 0.2)
        error = [a - b for a, b in zip(spin['in_body_mm'], CENTER_MM)]
        self.assertLess(chi2(error, spin['covariance_mm2']), CHI2_3)
        self.assertIn('--force', self.analyse('pivot.csv', code=2).stderr)
        self.analyse('pivot.csv', '--force')

    def test_poses_of_stated_noise(self):
        (self.base / 'stated.csv').write_text(poses_csv(pivot_poses()), encoding='utf-8')
        self.analyse('stated.csv', '--pose-sigma-deg', math.degrees(SIGMA_RAD), '--pose-sigma-mm',
                     SIGMA_MM)
        stated = self.center('stated-motion')
        self.expect_center(stated, 0.2)
        # The same as in the file's own columns.
        (self.base / 'own.csv').write_text(poses_csv(pivot_poses(), SIGMA_RAD, SIGMA_MM),
                                           encoding='utf-8')
        self.analyse('own.csv')
        for a, b in zip(stated['in_body_mm'], self.center('own-motion')['in_body_mm']):
            self.assertAlmostEqual(a, b, places=6)
        done = self.analyse('own.csv', '--pose-sigma-mm', '1', '--force', code=2)
        self.assertIn('has covariances of its own', done.stderr)

    def test_two_poses_are_no_answer(self):
        (self.base / 'two.csv').write_text(poses_csv(pivot_poses(2)), encoding='utf-8')
        self.analyse('two.csv', '--pose-sigma-deg', '1', '--pose-sigma-mm', '1', code=1)
        self.assertIn('too few poses', self.analyse('two.csv', '--force', code=2).stderr)

    def test_gaps(self):
        poses = pivot_poses()
        poses[20:23] = [None] * 3
        poses[40:50] = [None] * 10
        (self.base / 'gaps.csv').write_text(poses_csv(poses, SIGMA_RAD, SIGMA_MM),
                                            encoding='utf-8')
        self.analyse('gaps.csv', '--max-gap', '0.1', '--filter', 'rts')
        for name in ('motion.csv', 'filtered.csv'):
            status = [row['status'] for row in rows(self.base / 'gaps-motion' / name)]
            self.assertEqual(status[19:24], ['ok', 'filled', 'filled', 'filled', 'ok'])
            self.assertEqual(status[40:50], ['gap'] * 10)

    def test_free_path_knows_no_acceleration(self):
        (self.base / 'free.csv').write_text(poses_csv(pivot_poses(), SIGMA_RAD, SIGMA_MM),
                                            encoding='utf-8')
        self.analyse('free.csv', '--law', 'free', '--path-psd', '1')
        row = rows(self.base / 'free-motion/motion.csv')[30]
        self.assertEqual([row['accx_mm_s2'], row['u_accx']], ['', ''])
        self.assertTrue(row['vx_mm_s'])
        self.assertEqual(self.center('free-motion')['acceleration_mm_s2'], [None] * 3)

    def test_markers(self):
        rng = random.Random(6)
        frames = [seen_markers(pose, rng) for pose in true_poses(60)]
        frames[7][2] = None
        (self.base / 'trial.c3d').write_bytes(c3d(['P1', 'P2', 'P3', 'P4'], frames))
        done = self.analyse('trial.c3d')
        self.assertIn('rigid fit of 4 points', done.stderr)
        # σ of n ≈ 700 − 360 − 6 residuals scatters by 1 / √(2 n); 5 of that.
        sigma_mm = float(done.stderr.split('σ of a coordinate ')[1].split()[0])
        self.assertLess(abs(sigma_mm / 0.1 - 1), 5 / math.sqrt(2 * 350))
        self.expect_center(self.center('trial-motion'), 0.3)
        refused = self.analyse('trial.c3d', '--points', 'P1,Q*', '--force', code=2)
        self.assertIn("found no point 'Q*'", refused.stderr)
        self.assertIn('fewer than three points',
                      self.analyse('trial.c3d', '--points', 'P1,P2', '--force', code=2).stderr)
        self.assertIn('--point-sigma-mm',
                      self.analyse('trial.c3d', '--pose-sigma-mm', '1', '--force', code=2).stderr)

    # Two bodies that turn apart, taken for one: no answer, at once, and no files.
    def test_not_one_rigid_body(self):
        rng = random.Random(9)
        frames = [seen_markers(a, rng) + seen_markers(b, rng)
                  for a, b in zip(true_poses(60), reversed(true_poses(60)))]
        labels = [f'M{k}' for k in range(8)]
        (self.base / 'person.c3d').write_bytes(c3d(labels, frames))
        refused = self.analyse('person.c3d', code=1)
        self.assertIn('not one rigid body', refused.stderr)
        self.assertIn('--points', refused.stderr)
        self.assertFalse((self.base / 'person-motion').exists())

    # --points again is another body: both turn, alike but for the noise, about the same point.
    def test_two_clusters(self):
        rng = random.Random(8)
        first = true_poses(60)
        second = [about(turn([0.4 * math.cos(0.11 * i), 0, 0.4 * math.sin(0.17 * i)]), CENTER_MM,
                        PLACE_MM) for i in range(60)]
        frames = [seen_markers(a, rng) + seen_markers(b, rng) for a, b in zip(first, second)]
        labels = [f'{name}{k}' for name in ('thigh', 'shank') for k in range(4)]
        (self.base / 'leg.c3d').write_bytes(c3d(labels, frames))
        done = self.analyse('leg.c3d', '--points', 'thigh*', '--points',
                            'shank0,shank1,shank2,shank3')
        for body in ('body1', 'body2'):
            self.expect_center(self.center(f'leg-motion/{body}'), 0.3)
        joint = json.loads((self.base / 'leg-motion/joint.json').read_text(encoding='utf-8'))
        self.assertEqual([joint['first'], joint['second']], ['body1', 'body2'])
        self.assertIn('joint of body1 and body2', done.stdout)

    def test_what_is_refused(self):
        (self.base / 'pivot2.csv').write_text(poses_csv(pivot_poses()), encoding='utf-8')
        self.assertIn('--points', self.analyse('pivot2.csv', '--points', 'A', code=2).stderr)
        (self.base / 'broken.c3d').write_bytes(struct.pack('<BB', 2, 0x50) + bytes(600))
        self.assertIn('broken.c3d: ', self.analyse('broken.c3d', code=2).stderr)


if __name__ == '__main__':
    main()
