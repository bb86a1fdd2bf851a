"""koppel bench --peers: other engines come to the same references, or it is said how to get them."""

import unittest

from program import FINE, ProgramTest


class Peers(ProgramTest):
    def test_engines_come_to_the_reference_or_are_named(self):
        document = self.json(FINE, "bench", "--quick", "--peers", "simulation/pendulum")
        engines = {series["engine"] for series in document["simulations"][0]["series"]}
        self.assertEqual([peer["name"] for peer in document["peers"]], ["simbody", "mujoco", "dart"])
        for peer in document["peers"]:
            if not peer["found"]:
                self.assertIn("apt-get install", peer["help"])
                continue
            self.assertEqual(peer["left_out"], [])
            self.assertIn(peer["engine"], engines)

    def test_without_the_option_nobody_is_asked(self):
        document = self.json(FINE, "bench", "--quick", "simulation/pendulum")
        self.assertNotIn("peers", document)
        self.assertEqual({series["engine"] for series in document["simulations"][0]["series"]}, {"koppel"})


if __name__ == "__main__":
    unittest.main()
