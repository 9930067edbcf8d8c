"""How the programs of this folder end: exit codes and messages as those of muldi-sim."""

import sys
import traceback

WRONG_INPUT, ENVIRONMENT_FAILED, BUG = 2, 4, 70
PACKAGES = {"h5py": "python3-h5py", "numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "yaml": "python3-yaml"}


def fail(code, sentence):
    print(f"error: {sentence}", file=sys.stderr)
    sys.exit(code)


def run(verb, body):
    """Calls body(); WrongInput, missing modules and failing files become messages and exit codes."""
    try:
        body()
    except ModuleNotFoundError as error:
        module = (error.name or "").split(".")[0]
        package = PACKAGES.get(module, f"python3-{module}")
        fail(
            ENVIRONMENT_FAILED,
            f"{verb} needs the Python module {module} ({sys.executable} has none); as root: apt-get install {package} (tools/run {verb} does it by itself)",
        )
    except MemoryError:
        fail(ENVIRONMENT_FAILED, "out of memory")
    except Exception as error:  # noqa: BLE001  every end has its code
        if type(error).__name__ == "WrongInput":
            fail(WRONG_INPUT, error)
        if "h5py" in traceback.extract_tb(error.__traceback__)[-1].filename:
            fail(WRONG_INPUT, f"a result is damaged: {error}")
        if isinstance(error, OSError):
            fail(ENVIRONMENT_FAILED, error)
        traceback.print_exc()
        fail(BUG, f"internal error, please report it: {error}")
