"""A visit of the doctor: everything is looked at, whatever is wrong with the rest."""

from collections.abc import Callable, Iterator

from studio.doctor import cache, database, installation, machine
from studio.doctor.finding import TROUBLE, Check, Finding, Patient, in_one_line

CHECKS: dict[str, Check] = {
    "packages": installation.versions,
    "page": installation.page,
    "machine code": installation.code,
    "database": database.database,
    "compiled": cache.code,
    "maps": cache.maps,
    "space": machine.space,
    "port": machine.port,
}


def examined(patient: Patient, report: Callable[[float], None]) -> Iterator[Finding]:
    """What is found, one after another. What cannot be looked at is bad, and says why."""
    for i, (name, check) in enumerate(CHECKS.items()):
        try:
            yield from check(patient)
        except TROUBLE as error:
            yield Finding(name, False, f"cannot be looked at: {in_one_line(error)}")
        report((i + 1) / len(CHECKS))


def mended(finding: Finding) -> tuple[bool, str]:
    """Mends what was found, where that can be done: whether it is, and what was done, or why not."""
    if finding.mend is None:
        return False, ""
    try:
        return True, finding.mend()
    except TROUBLE as error:
        return False, in_one_line(error)
