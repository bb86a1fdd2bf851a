"""What the README shows is tried."""

import pathlib
import re
import unittest

from program import FINE, FOURBAR, ProgramTest

ROOT = pathlib.Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()


class Scene(ProgramTest):
    def test_the_first_scene_has_the_mobility_that_is_told(self):
        scene = self.write("fourbar.toml", re.search(r"```toml\n(schema.*?)```", README, re.DOTALL).group(1))
        self.assertEqual(self.json(FINE, "check", scene)["mobility"], {"count": -2, "rank": 1})
        self.assertLess(self.json(FINE, "run", scene)["max_residual"], 1e-13)


class Commands(ProgramTest):
    def test_every_option_shown_exists(self):
        for command in ("explain", "modes", "run"):
            shown = set(re.findall(rf"koppel {command} [^\n#|`]*", README))
            self.assertTrue(shown)
            known = self.expect(FINE, "koppel", command, "--help").stdout
            for line in shown:
                for option in re.findall(r"--[a-z-]+", line):
                    self.assertIn(option, known)

    def test_every_code_shown_is_explained(self):
        codes = re.findall(r"koppel explain ([EWN]\d+)", README)
        self.assertTrue(codes)
        for code in codes:
            self.assertNotEqual(self.expect(FINE, "koppel", "explain", code).stdout, "")

    def test_what_is_shown_is_printed(self):
        shown = re.findall(r"^```\n\$ koppel ([^\n]*)\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)
        self.assertTrue(shown)
        for arguments, text in shown:
            words = [ROOT / word if word.startswith("apps/") else word for word in arguments.split()]
            printed = self.expect(FINE, "koppel", *words).stdout
            # Residuals are rounding: another machine has others.
            for pattern in (r"\d\.\de[+-]\d\d", r" +$"):
                printed, text = re.sub(pattern, "", printed), re.sub(pattern, "", text)
            self.assertEqual(printed, text)

    def test_the_table_of_json_keys_is_complete(self):
        scene = self.write("fourbar.toml", FOURBAR)
        rows = re.findall(r"^\| (`.*) \| (.*) \| .* \|$", README, re.MULTILINE)
        for name, groups in (("check", ("all", "both")), ("run", ("all", "both")), ("modes", ("all",))):
            told = {key for keys, of in rows if of in (*groups, f"`{name}`") for key in re.findall(r"`(\w+)`", keys)}
            self.assertEqual(set(self.json(FINE, name, scene)) - told, set())


class Links(unittest.TestCase):
    def test_every_link_leads_to_a_file(self):
        links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
        self.assertTrue(links)
        self.assertEqual([link for link in links if not (ROOT / link).exists()], [])


if __name__ == "__main__":
    unittest.main()
