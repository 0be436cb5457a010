# SPDX-License-Identifier: GPL-3.0-or-later
"""Every parameter file of prm/ is read, built and found without a mistake."""
import os
import pathlib

from run_case import Test

test = Test()
cases = pathlib.Path(os.environ["CORACLE_TOP"]) / "prm"
files = sorted(cases.glob("*/*.prm"))
test.check("there are cases", len(files) > 0)
for file in files:
    test.run(str(file.relative_to(cases)), options=["--check"])
test.finish()
