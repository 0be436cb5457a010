# SPDX-License-Identifier: GPL-3.0-or-later
"""The manufactured vortex is met with second order in the mean over the particles, at a quarter period."""
import os
import re
import subprocess

from run_case import Test

test = Test()
script = os.environ["CORACLE_TOP"] + "/prm/vortex/convergence.py"
for case in ("vortex", "smooth"):
    command = [script, os.environ["CORACLE"], "-c", case, "-l", "3", "-o", case]
    done = subprocess.run(command + ["--set", "End time=0.25"], stdout=subprocess.PIPE, text=True)
    print(done.stdout)
    orders = [float(o) for o in re.findall(r"mean error \S+ m \(order +([-.\d]+)\)", done.stdout)]
    test.check(f"{case}: runs", done.returncode == 0 and len(orders) > 0)
    if orders:
        test.band(f"{case}: order from 1/16 to 1/32", orders[-1], 1.8, 3)
test.finish()
