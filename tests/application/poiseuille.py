# SPDX-License-Identifier: GPL-3.0-or-later
"""A driven periodic channel meets the exact velocity with second order in spacing and steps, keeps
its volume, has no free surface, and is the same on two ranks."""
import os
import re
import subprocess

from run_case import Test

test = Test()
script = os.environ["CORACLE_TOP"] + "/prm/poiseuille/convergence.py"
done = subprocess.run([script, os.environ["CORACLE"], "-l", "3", "-o", "orders"], stdout=subprocess.PIPE, text=True)
print(done.stdout)
test.check("the orders are found", done.returncode == 0)
for what, least in (("both", 1.8), ("steps", 1.8)):
    orders = [float(o) for o in re.findall(rf"order in {what} ([-.\d]+\d)\)", done.stdout)]
    if test.check(f"orders in {what} are told", len(orders) >= 2):
        test.band(f"order in {what}", orders[-1], least, 3)
short = {"Output/Particle format": "none", "End time": "0.2"}
one, two = (test.run("poiseuille/poiseuille.prm", short, ranks=ranks) for ranks in (1, 2))
test.check("the verdict is OK", "verdict: OK" in one.text)
test.agree("velocity on 1 and 2 ranks", one["oil.velocity.x [m/s]"][-1], two["oil.velocity.x [m/s]"][-1], 1e-8)
test.band("drift of volume", max(map(abs, one["oil.volume_drift"])), 0, 1e-12)
test.band("points at a free surface", max(one["oil.points.free"]), 0, 0)
test.finish()
