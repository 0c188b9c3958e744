#!/usr/bin/env python3
"""Runs `analyse` end to end: a simulated run, bad use.

Usage: analyse_test.py PATH/TO/stereomotion [unittest options]
"""

import json
import math
import shutil

from motion_case import MotionCase
from small_recording import BODY, NOISE, RIG, main, rows

RATE_RAD_S = 2.0
SCENARIO = """format: stereomotion-scenario/1
name: analyse
rig: rig.yaml
body: body.yaml
motion:
  law: fixed
  center_in_world_mm: [20, 10, 0]
  axis: [0, 0, 1]
  rate_rad_s: %g
frames: 16
fps: 30
""" % RATE_RAD_S


class Analyse(MotionCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write(rig=RIG + NOISE, body=BODY)
        cls.simulate(SCENARIO)
        done = cls.run_program('track', '--left', 'rec/cam0', '--right', 'rec/cam1', '--rig',
                               'rig.yaml', '--body', 'body.yaml', '--output', 'run')
        assert done.returncode == 0, done.stderr

    def test_a_run_again(self):
        kept = {name: (self.base / 'run' / name).read_bytes()
                for name in ('poses.csv', 'balls.csv', 'detections.csv')}
        record = json.loads((self.base / 'run/run.json').read_text(encoding='utf-8'))
        self.analyse('run', '--law', 'fixed', '--filter', 'butterworth', '--angles', 'zxy',
                     '--relative-to', '0')
        for name, content in kept.items():
            self.assertEqual((self.base / 'run' / name).read_bytes(), content, name)
        after = json.loads((self.base / 'run/run.json').read_text(encoding='utf-8'))
        self.assertIn('6', after.pop('analysis')['filter'])
        record.pop('analysis', None)
        self.assertEqual(after, record)
        motion = json.loads((self.base / 'run/motion.json').read_text(encoding='utf-8'))
        spin = motion['spin_center']
        self.assertEqual(spin['law'], 'fixed')
        # About one axis, z: the centre is free along it and known across it.
        self.assertIsNotNone(spin['free_axis_in_body'])
        for k, truth in enumerate((20, 10)):
            u = math.sqrt(spin['in_world_covariance_mm2'][k][k])
            self.assertLess(abs(spin['in_world_mm'][k] - truth), 5 * u)
        table = rows(self.base / 'run/motion.csv')
        self.assertEqual(len(table), 16)
        for row in table:
            self.assertLess(abs(float(row['wz_rad_s']) - RATE_RAD_S), 5 * float(row['u_wz']))
        self.assertEqual(len(rows(self.base / 'run/filtered.csv')), 16)
        relative = rows(self.base / 'run/relative.csv')
        self.assertAlmostEqual(float(relative[0]['qw']), 1)
        angles = rows(self.base / 'run/angles.csv')
        self.assertAlmostEqual(float(angles[15]['angle1_z_rad']), RATE_RAD_S * 15 / 30, places=3)
        self.assertTrue(rows(self.base / 'run/axes.csv'))

    def test_same_bytes_again(self):
        self.analyse('run', '--output', 'a')
        self.analyse('run', '--output', 'b')
        for name in ('motion.csv', 'motion.json', 'axes.csv'):
            self.assertEqual((self.base / 'a' / name).read_bytes(),
                             (self.base / 'b' / name).read_bytes(), name)

    def test_what_is_refused(self):
        for arguments, words in (
                (('nowhere',), 'nowhere: no such file'),
                (('rec',), 'no poses.csv'),
                (('run', '--law', 'circular'), '--law'),
                (('run', '--path-psd', '1'), '--law free'),
                (('run', '--angles', 'zzz'), '--angles'),
                (('run', '--relative-to', '99'), '--relative-to'),
                (('run', '--relative-to', 'bodie'), '--relative-to'),
                (('run', '--joint', 'knee'), 'expected two'),
                (('run', '--cutoff-hz', '6'), '--filter butterworth'),
                (('run', '--filter', 'rts', '--order', '4'), '--filter butterworth'),
                (('run', '--side', 'left'), '--joint'),
                (('run', '--output', ''), '--output'),
                (('run', '--filter', 'butterworth', '--cutoff-hz', '15'), '--filter')):
            with self.subTest(arguments=arguments):
                self.assertIn(words, self.analyse(*arguments, code=2).stderr)

    def files(self, folder):
        return {file.name: file.read_bytes() for file in (self.base / folder).iterdir()}

    # What is refused only after the analysis leaves the RUN as it was, too.
    def test_refused_changes_nothing(self):
        shutil.copytree(self.base / 'run', self.base / 'refused')
        before = self.files('refused')
        for arguments in (('--relative-to', '999'),
                          ('--filter', 'butterworth', '--cutoff-hz', '15')):
            self.analyse('refused', '--law', 'accelerated', *arguments, code=2)
            self.assertEqual(self.files('refused'), before, arguments)
            self.analyse('refused', '--output', 'none', *arguments, code=2)
            self.assertFalse((self.base / 'none').exists())

    # Beside the new motion no file of an earlier analysis stays; files of others do.
    def test_nothing_stale(self):
        self.analyse('run', '--output', 'stale', '--filter', 'butterworth', '--angles', 'zxy',
                     '--relative-to', '0')
        for name in ('joint.json', 'joint_angles.csv', 'notes.csv'):
            (self.base / 'stale' / name).write_text('', encoding='utf-8')
        self.analyse('run', '--output', 'stale', '--force', '--angles', 'zxy')
        self.assertEqual(sorted(self.files('stale')),
                         ['angles.csv', 'axes.csv', 'motion.csv', 'motion.json', 'notes.csv'])

    # Where nothing was analysed before, a file of such a name is somebody else's.
    def test_foreign_files_stay(self):
        (self.base / 'foreign').mkdir()
        (self.base / 'foreign/filtered.csv').write_text('mine', encoding='utf-8')
        self.analyse('run', '--output', 'foreign')
        self.assertEqual(self.files('foreign')['filtered.csv'], b'mine')

    def test_changed_rig_is_told(self):
        shutil.copytree(self.base / 'run', self.base / 'older')
        (self.base / 'older/rig.yaml').unlink(missing_ok=True)
        shutil.copy(self.base / 'rig.yaml', self.base / 'rig.kept')
        with open(self.base / 'rig.yaml', 'a', encoding='utf-8') as stream:
            stream.write('# changed\n')
        try:
            self.assertIn('SHA-256', self.analyse('older', code=2).stderr)
        finally:
            shutil.move(self.base / 'rig.kept', self.base / 'rig.yaml')
        self.analyse('older')

    def test_help(self):
        self.assertIn('Examples:', self.analyse('--help').stdout)


if __name__ == '__main__':
    main()
