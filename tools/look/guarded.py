"""How the programs of this folder end: exit codes and messages as those of muldi-sim."""

import contextlib
import os
import signal
import sys
import traceback

SECONDS = 15  # of processor time, within which HDF5 must have read one thing, and more for large files:
BYTES_A_SECOND = 1e7
WRONG_INPUT, ENVIRONMENT_FAILED, BUG = 2, 4, 70
PACKAGES = {"h5py": "python3-h5py", "numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "yaml": "python3-yaml"}


def fail(code, sentence):
    print(f"error: {sentence}", file=sys.stderr)
    sys.exit(code)


@contextlib.contextmanager
def reading(size):
    """Inside, HDF5 has SECONDS and some for a file of this size; it may follow damaged structures for ever, and Python cannot interrupt it, so that
    the process ends by a signal, which its parent explains."""
    signal.setitimer(signal.ITIMER_PROF, SECONDS + size / BYTES_A_SECOND)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def run(verb, body):
    """Runs body() in a process of its own, which damaged files may end by a signal; ends with its exit code."""
    child = os.fork()
    if child == 0:
        end_of(verb, body)
        sys.exit(0)
    signal.signal(signal.SIGTERM, lambda number, _: os.kill(child, number))
    while True:
        try:
            _, status = os.waitpid(child, 0)
            break
        except KeyboardInterrupt:  # the child has had it too
            continue
    if not os.WIFSIGNALED(status):
        sys.exit(os.WEXITSTATUS(status))
    number = os.WTERMSIG(status)
    if number == signal.SIGPROF:
        fail(WRONG_INPUT, "a result is damaged: HDF5 does not come to an end with it")
    if number in (signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT, signal.SIGFPE):
        fail(WRONG_INPUT, f"a result is damaged: HDF5 was ended by signal {number} as it read it")
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def end_of(verb, body):
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
