"""plot.py [--what LIST] -o FIGURE FILE...: curves of result files as a figure; called by `muldi-sim plot`, which checks the words."""

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

    results = result.open_all(arguments.files)
    panels = curves.all_panels(results, [kind for kind in arguments.what.split(",") if kind])
    figures.save(figures.figure_of(panels), arguments.output)


if __name__ == "__main__":
    guarded.run("plot", main)
