"""plot.py [--what LIST] -o FIGURE FILE...: curves of result files, tables of sweeps and fits as a figure; called by `muldi-sim plot`, which checks the words."""

import argparse

import guarded


def main():
    parser = argparse.ArgumentParser(prog="muldi-sim plot")
    parser.add_argument("--what", default="")
    parser.add_argument("-o", dest="output", required=True)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()

    import curves
    import figures
    import result
    import studies

    results = result.open_all(arguments.files)
    kinds = [kind for kind in arguments.what.split(",") if kind]
    panels = studies.panels_of(results, kinds) if studies.has_study(results) else curves.all_panels(results, kinds)
    figures.save(figures.figure_of(panels), arguments.output)


if __name__ == "__main__":
    guarded.run("plot", main)
