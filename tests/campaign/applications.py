"""Applications that misbehave, in the middle of a run."""

from tests.broken import BROKEN

RAISE = 'raise RuntimeError("the idea was not so good")'


def doing(what: str, *, title: str) -> str:
    """An application that does this half a second into the run, and goes on as if nothing had been."""
    assert RAISE in BROKEN
    lines = f"{IMPORTS}{what.strip()}".replace("\n", "\n        ")
    return BROKEN.replace("Raises", title).replace(RAISE, lines)


IMPORTS = "import os, resource, signal, subprocess, sys, threading, time\n"
APPLICATIONS = {
    "ending": doing("os._exit(3)", title="Ends its process"),
    "leaving": doing("sys.exit('enough')", title="Wants to leave"),
    "interrupting": doing("raise KeyboardInterrupt", title="Raises what is no error"),
    "crashing": doing("os.kill(os.getpid(), signal.SIGSEGV)", title="Crashes"),
    "stopping": doing("os.kill(os.getpid(), signal.SIGSTOP)", title="Stops its process"),
    "deaf": doing(
        """
for each in set(range(1, 32)) - {signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD}:
    signal.signal(each, signal.SIG_IGN)
while True:
    pass""",
        title="Hears no signal and never ends",
    ),
    "sleeping": doing("time.sleep(1e6)", title="Sleeps"),
    "forking": doing(
        """
for _ in range(20):
    if os.fork() == 0:
        time.sleep(1e6)
        os._exit(0)
time.sleep(1e6)""",
        title="Forks",
    ),
    "scattering": doing(
        """
for _ in range(5):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            time.sleep(1e6)
        os._exit(0)
subprocess.Popen(['sleep', '1000000'], start_new_session=True)
raise SystemExit""",
        title="Forks into sessions of their own and leaves",
    ),
    "printing": doing(
        """
for _ in range(300):
    print('x' * 10000, flush=True)
    print('y' * 10000, file=sys.stderr, flush=True)""",
        title="Prints",
    ),
    "eating": doing(
        """
resource.setrlimit(resource.RLIMIT_AS, (6 * 10**9, 6 * 10**9))
eaten = []
while True:
    eaten.append(bytearray(10**8))""",
        title="Eats memory",
    ),
    "closing": doing("os.closerange(3, 1000)", title="Closes every file"),
    "threading_": doing(
        """
for _ in range(50):
    threading.Thread(target=time.sleep, args=(1e6,)).start()""",
        title="Begins threads that do not end",
    ),
    "recursing": doing("(again := lambda: again())()", title="Calls itself"),
    "writing": doing(
        """
for each in range(3, 10):
    os.write(each, b'x' * 1000)""",
        title="Writes into whatever is open",
    ),
}
