#!/usr/bin/env python3
"""Runs `analyse` on a run of two bodies, and against a disk that fails in the middle.

Usage: analyse_bodies_test.py PATH/TO/stereomotion [unittest options]
"""

import json
import math
import random
import resource
import shutil

from motion_case import CHI2_3, MotionCase, about, chi2, noisy, poses_csv, product, turn
from small_recording import main, rows

SIGMA_RAD, SIGMA_MM = 0.001, 0.05
HIP_MM, KNEE_IN_THIGH_MM, KNEE_IN_SHANK_MM = (0, 900, 0), (5, -400, 10), (0, 30, -20)
FRAMES = 60


def flexion(i):
    return 0.3 + 0.5 * math.sin(0.1 * i)


def leg():
    """Thigh about the hip at rest; shank about the thigh's z axis through the knee: a hinge."""
    poses = []
    for i in range(FRAMES):
        thigh = about(turn([0.3 * math.sin(0.07 * i), 0.2 * math.cos(0.09 * i), 0.01 * i]),
                      (0, 0, 0), HIP_MM)
        knee = [t + sum(a * b for a, b in zip(row, KNEE_IN_THIGH_MM))
                for row, t in zip(*thigh)]
        shank = about(product(thigh[0], turn([0, 0, flexion(i)])), KNEE_IN_SHANK_MM, knee)
        poses.append((thigh, shank))
    return poses


class Bodies(MotionCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rng = random.Random(3)
        for k, name in enumerate(('thigh', 'shank')):
            (cls.base / 'run' / name).mkdir(parents=True)
            poses = [noisy(both[k], rng, SIGMA_RAD, SIGMA_MM) for both in leg()]
            (cls.base / 'run' / name / 'poses.csv').write_text(
                poses_csv(poses, SIGMA_RAD, SIGMA_MM), encoding='utf-8')
        (cls.base / 'run/run.json').write_text(
            '{"format": "stereomotion-run/1", "cameras": {"left": "cam0", "right": "cam1"}, '
            '"inputs": []}\n',
            encoding='utf-8')

    def test_joint(self):
        done = self.analyse('run', '--relative-to', 'thigh', '--joint', 'knee', '--angles', 'zxy')
        self.assertIn('joint of shank and thigh', done.stdout)
        joint = json.loads((self.base / 'run/joint.json').read_text(encoding='utf-8'))
        self.assertEqual(joint['format'], 'stereomotion-joint/1')
        self.assertEqual([joint['first'], joint['second']], ['shank', 'thigh'])
        # A hinge: the centre is free along z; across it the two numbers' χ² is below three's.
        center, truth = joint['center'], KNEE_IN_THIGH_MM
        self.assertIsNotNone(center['free_axis_in_first'])
        across = [row[3:5] + [0] for row in center['covariance_mm2'][3:5]] + [[0, 0, 1]]
        error = [center['in_second_mm'][k] - truth[k] for k in range(2)] + [0]
        self.assertLess(chi2(error, across), CHI2_3)
        self.assertGreater(abs(joint['axis']['in_second'][2]), math.cos(0.01))

        # Two poses' noise about an axis; 5 σ of each of 60 frames.
        angles = rows(self.base / 'run/joint_angles.csv')
        self.assertEqual(len(angles), FRAMES)
        for key in angles[0]:
            self.assertRegex(key, r'^[a-z][a-z0-9_]*$')
        self.assertIn('u_internal_rotation_rad', angles[0])
        name = 'flexion_rad'
        for i, row in enumerate(angles):
            self.assertLess(abs(abs(float(row[name])) - abs(flexion(i))),
                            5 * math.sqrt(2) * SIGMA_RAD)
        relative = rows(self.base / 'run/shank/relative.csv')
        self.assertLess(abs(float(relative[0]['qz']) - math.sin(flexion(0) / 2)),
                        5 * math.sqrt(2) * SIGMA_RAD / 2)
        self.assertTrue((self.base / 'run/shank/angles.csv').exists())
        # Against itself the base has no angles.
        self.assertFalse((self.base / 'run/thigh/relative.csv').exists())

    def test_hip_rests(self):
        self.analyse('run', '--output', 'out')
        spin = json.loads((self.base / 'out/thigh/motion.json').read_text())['spin_center']
        self.assertEqual(spin['law'], 'fixed')
        error = [a - b for a, b in zip(spin['in_world_mm'], HIP_MM)]
        self.assertLess(chi2(error, spin['in_world_covariance_mm2']), CHI2_3)

    def test_lost_body_is_told(self):
        shutil.copytree(self.base / 'run', self.base / 'lost')
        (self.base / 'lost/run.json').write_text(json.dumps(
            {'format': 'stereomotion-run/1', 'cameras': {'left': 'cam0', 'right': 'cam1'},
             'inputs': [], 'bodies': [{'name': name, 'folder': name}
                                      for name in ('thigh', 'shank', 'foot')]}), encoding='utf-8')
        told = self.analyse('lost').stderr
        self.assertIn("'foot'", told)
        self.assertNotIn("'thigh'", told)

    def test_what_is_refused(self):
        for arguments, words in (
                (('--relative-to', 'tigh'), "did you mean 'thigh'"),
                (('--joint', 'kne'), "did you mean 'knee'"),
                (('--angles', 'zzz'), '--angles'),
                (('--pose-sigma-mm', '1'), 'covariances of its own')):
            with self.subTest(arguments=arguments):
                self.assertIn(words, self.analyse('run', '--output', 'no', *arguments,
                                                  code=2).stderr)

    # A limit of the file size ends a write in its middle, by a signal or an error. What stood there
    # before stays, whole.
    def test_interrupted(self):
        self.analyse('run', '--law', 'fixed')
        shutil.copytree(self.base / 'run', self.base / 'before')
        kept = [file.relative_to(self.base / 'before')
                for file in (self.base / 'before').rglob('*') if file.is_file()]
        for limit in (1, 1000, 3000, 10000):
            done = self.run_program(
                'analyse', 'run', '--law', 'uniform',
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            self.assertNotEqual(done.returncode, 0)
            for name in kept:
                self.assertEqual((self.base / 'run' / name).read_bytes(),
                                 (self.base / 'before' / name).read_bytes(), name)


if __name__ == '__main__':
    main()
