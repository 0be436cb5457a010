# SPDX-License-Identifier: GPL-3.0-or-later
"""The tip of a cantilever under a dead load is within 1 % of the elastica, bent little and far."""
from run_case import Test

test = Test()
for load, back, down in ((1, 0.0564332, 0.301721), (5, 0.387628, 0.713792)):
    result = test.run(
        "elastica/elastica.prm",
        {
            "Bodies/beam/Mesh/Subdivisions": "40, 2",
            "Bodies/beam/Loads/tip/Traction": f"0; -{load}*208.3333333*min(t, 1)",
        },
    )
    test.band(f"load {load}: back", -result["beam.tip.displacement.x [m]"][-1] / back, 0.99, 1.01)
    test.band(f"load {load}: down", -result["beam.tip.displacement.y [m]"][-1] / down, 0.99, 1.01)
    test.band("energy balance", abs(result["energy.balance_error"][-1]), 0, 1e-9)
test.finish()
