"""What a vehicle file may say: every value with its unit and range, and where it comes from.

    title: Smart fortwo
    tyres: {front: smart_175_55r15, rear: smart_175_55r15}
    body:
      mass: {value: 860, unit: kg, origin: published, source: "Massow & Radusch 2018, Table 4", range: [800, 900]}

A leaf is `value` with `unit`, `origin` (published, measured or estimated), `source` and, where it is known, a `range` within
which the true value may lie (of a list: within which every entry lies). A plain number is taken as well, as estimated without
a source (scenario/datasheet.py). Nothing is repaired: a value outside what is physically possible is refused with its field,
value and range. `set` changes one value by its path (`body.mass`).
"""

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from studio.conventions import GRAVITY

RPM = 0.10471975511965977  # [rad/s] one revolution per minute
MOST_GEARS = 8
MOST_POINTS = 100  # of a full-load curve as a file gives it


def number(*, unit: str, title: str, **bounds):
    """A value that must be given, with its unit and range."""
    return Field(..., title=title, json_schema_extra={"unit": unit}, **bounds)


def numbers(*, unit: str, title: str, least: int = 1, most: int = MOST_POINTS, **bounds):
    """A list of values, one for each gear or point."""
    item = Annotated[float, Field(**bounds)]
    return Annotated[list[item], Field(min_length=least, max_length=most, title=title, json_schema_extra={"unit": unit})]


def refuse(part, *sentences):
    """The part itself, or ValueError with all sentences; what is false is no sentence."""
    wrong = [sentence for sentence in sentences if sentence]
    if wrong:
        raise ValueError("; ".join(wrong))
    return part


class Part(BaseModel):
    """Base of all parts: unknown fields are refused; numbers must be numbers (no texts, no true or false), and finite."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, strict=True, frozen=True)


class Body(Part):
    """Masses and dimensions. The centre of gravity is that of the whole vehicle with its crew."""

    mass: float = number(unit="kg", title="Mass of the whole vehicle with crew", ge=300, le=60_000)
    unsprung_mass_front: float = number(unit="kg", title="Unsprung mass, both front wheels", ge=10, le=3000)
    unsprung_mass_rear: float = number(unit="kg", title="Unsprung mass, both rear wheels", ge=10, le=6000)
    roll_inertia: float = number(unit="kg m²", title="Roll inertia of the body", ge=30, le=60_000)
    pitch_inertia: float = number(unit="kg m²", title="Pitch inertia of the body", ge=100, le=600_000)
    yaw_inertia: float = number(unit="kg m²", title="Yaw inertia of the whole vehicle", ge=100, le=600_000)
    wheelbase: float = number(unit="m", title="Wheelbase", ge=1.2, le=8)
    front_distance: float = number(unit="m", title="Centre of gravity behind the front axle", gt=0.2, le=7)
    gravity_height: float = number(unit="m", title="Centre of gravity above ground", ge=0.15, le=3)
    front_track: float = number(unit="m", title="Track, front", ge=0.8, le=3)
    rear_track: float = number(unit="m", title="Track, rear", ge=0.8, le=3)
    length: float = number(unit="m", title="Length", ge=1.8, le=20)
    width: float = number(unit="m", title="Width", ge=1.0, le=3)
    height: float = number(unit="m", title="Height", ge=0.8, le=4.5)
    front_overhang: float = number(unit="m", title="Front axle to front bumper", ge=0.1, le=3)

    @model_validator(mode="after")
    def is_possible(self):
        unsprung = self.unsprung_mass_front + self.unsprung_mass_rear
        reach = self.front_overhang + self.wheelbase
        track = max(self.front_track, self.rear_track)
        return refuse(
            self,
            (self.front_distance >= self.wheelbase)
            and f"front_distance {self.front_distance:g} m must be less than the wheelbase {self.wheelbase:g} m",
            (unsprung > 0.5 * self.mass) and f"the unsprung masses, {unsprung:g} kg, are more than half of the mass, {self.mass:g} kg",
            (reach >= self.length) and f"front_overhang + wheelbase, {reach:g} m, exceed the length {self.length:g} m",
            (track >= self.width) and f"a track of {track:g} m does not fit under a width of {self.width:g} m",
            (self.gravity_height >= self.height)
            and f"gravity_height {self.gravity_height:g} m must be less than the height {self.height:g} m",
            *self.inertias(),
        )

    def inertias(self):
        """No mass within a box has more inertia about an axis than it would have at the box's farthest edges: m (a² + b²)/4."""
        sizes = {"roll": (self.width, self.height), "pitch": (self.length, self.height), "yaw": (self.length, self.width)}
        for axis, (a, b) in sizes.items():
            most, given = 0.25 * self.mass * (a * a + b * b), getattr(self, f"{axis}_inertia")
            yield (given > most) and (
                f"{axis}_inertia {given:g} kg m² is more than {self.mass:g} kg within {a:g} m by {b:g} m can have: at most {most:.0f} kg m²"
            )


class Suspension(Part):
    """Per wheel, at the wheel: springs and dampers; per axle: anti-roll bar, roll centre, camber."""

    stiffness_front: float = number(unit="N/m", title="Spring, front", ge=3000, le=2_000_000)
    stiffness_rear: float = number(unit="N/m", title="Spring, rear", ge=3000, le=2_000_000)
    damping_front: float = number(unit="N s/m", title="Damper, front", ge=100, le=200_000)
    damping_rear: float = number(unit="N s/m", title="Damper, rear", ge=100, le=200_000)
    anti_roll_front: float = number(unit="Nm/rad", title="Anti-roll bar, front (0: none)", ge=0, le=1_000_000)
    anti_roll_rear: float = number(unit="Nm/rad", title="Anti-roll bar, rear (0: none)", ge=0, le=1_000_000)
    roll_centre_front: float = number(unit="m", title="Roll centre above ground, front", ge=-0.2, le=1)
    roll_centre_rear: float = number(unit="m", title="Roll centre above ground, rear", ge=-0.2, le=1)
    camber_front: float = number(unit="rad", title="Static camber, front (negative: top inward)", ge=-0.15, le=0.15)
    camber_rear: float = number(unit="rad", title="Static camber, rear (negative: top inward)", ge=-0.15, le=0.15)
    camber_gain_front: float = number(unit="rad/m", title="Camber per travel, front", ge=-3, le=3)
    camber_gain_rear: float = number(unit="rad/m", title="Camber per travel, rear", ge=-3, le=3)


class Wheels(Part):
    """Rolling and vertical properties; a pair of twin wheels counts as one."""

    radius: float = number(unit="m", title="Effective rolling radius", ge=0.15, le=0.8)
    inertia_front: float = number(unit="kg m²", title="Spin inertia of one front wheel", ge=0.05, le=200)
    inertia_rear: float = number(unit="kg m²", title="Spin inertia of one rear wheel", ge=0.05, le=200)
    stiffness_front: float = number(unit="N/m", title="Vertical tyre stiffness, front", ge=50_000, le=5_000_000)
    stiffness_rear: float = number(unit="N/m", title="Vertical tyre stiffness, rear", ge=50_000, le=5_000_000)
    damping: float = number(unit="N s/m", title="Vertical tyre damping", ge=0, le=20_000)
    rolling_resistance: float = number(unit="1", title="Rolling resistance over load", ge=0, le=0.1)


class Steering(Part):
    """Rack with an electric actuator: angle control, or torque control at the steering wheel."""

    ratio: float = number(unit="1", title="Steering wheel over road wheel angle", ge=5, le=40)
    angle_max: float = number(unit="rad", title="Greatest road wheel angle", ge=0.2, le=1.2)
    rate_max: float = number(unit="rad/s", title="Greatest speed of the road wheel angle", ge=0.05, le=5)
    time: float = number(unit="s", title="Time constant of the angle control", ge=0, le=1)
    inertia: float = number(unit="kg m²", title="Inertia about the steering wheel's axis", ge=0.005, le=1)
    damping: float = number(unit="Nm s/rad", title="Damping about the steering wheel's axis", ge=0.05, le=20)
    caster_trail: float = number(unit="m", title="Mechanical trail", ge=0, le=0.1)
    assistance: float = number(unit="1", title="Share of the aligning torque that the power steering takes over", ge=0, le=0.99)


class Brakes(Part):
    """Hydraulics per axle: first order with a dead time."""

    torque_max: float = number(unit="Nm", title="Greatest brake torque, sum of all wheels", ge=500, le=200_000)
    pressure_max: float = number(unit="Pa", title="Pressure that gives it", ge=100_000, le=30_000_000)
    front_share: float = number(unit="1", title="Share of the front axle", ge=0, le=1)
    time: float = number(unit="s", title="Time constant", ge=0, le=1)
    delay: float = number(unit="s", title="Dead time", ge=0, le=0.3)


class Engine(Part):
    """Combustion engine or electric motor: full-load curve, drag, lag. Torques are those at the shaft."""

    kind: Literal["combustion", "electric"]
    speeds: numbers(unit="rad/s", title="Speeds of the full-load curve, from 0 upwards", least=2, ge=0, le=3000)
    torques: numbers(unit="Nm", title="Full-load torque at these speeds", least=2, ge=0, le=10_000)
    drag_torque: float = number(unit="Nm", title="Drag torque with the pedal lifted, at low speed", ge=0, le=1000)
    drag_slope: float = number(unit="Nm s/rad", title="Growth of the drag torque with speed", ge=0, le=5)
    regeneration: float = number(unit="Nm", title="Braking torque beyond the drag, on request (electric)", ge=0, le=5000)
    inertia: float = number(unit="kg m²", title="Inertia with flywheel", ge=0.005, le=10)
    idle_speed: float = number(unit="rad/s", title="Idle speed (electric: 0)", ge=0, le=200)
    limit_speed: float = number(unit="rad/s", title="Rev limit", ge=100, le=3000)
    time: float = number(unit="s", title="Time constant", ge=0, le=2)
    delay: float = number(unit="s", title="Dead time", ge=0, le=0.3)

    @model_validator(mode="after")
    def is_a_curve(self):
        if len(self.speeds) != len(self.torques):
            raise ValueError(f"{len(self.speeds)} speeds but {len(self.torques)} torques: one for each")
        if self.speeds[0] != 0 or any(b <= a for a, b in zip(self.speeds, self.speeds[1:], strict=False)):
            raise ValueError("speeds must begin with 0 and rise")
        if self.kind == "combustion" and not 30 <= self.idle_speed < self.limit_speed:
            raise ValueError(f"a combustion engine idles between 30 rad/s and its limit of {self.limit_speed} rad/s")
        return self


class Coupling(Part):
    """What joins engine and gearbox: an automated clutch, a torque converter with lock-up, or nothing that opens."""

    kind: Literal["clutch", "converter", "rigid"]
    capacity: float = number(unit="Nm", title="Greatest torque of the closed clutch or lock-up", ge=10, le=100_000)
    launch_speed: float = number(unit="rad/s", title="Engine speed at which a full-load start slips", ge=0, le=600)
    lock_up_speed: float = number(unit="rad/s", title="Turbine speed above which the lock-up closes", ge=0, le=1000)
    pump: numbers(unit="Nm s²/rad²", title="Converter, torque of the pump: a1, a2, a3", least=3, most=3, ge=-10, le=10)
    turbine: numbers(unit="Nm s²/rad²", title="Converter, torque of the turbine: b1, b2, b3", least=3, most=3, ge=-10, le=10)
    fluid: numbers(unit="Nm s²/rad²", title="Converter as a fluid coupling: c1, c2, c3", least=3, most=3, ge=-10, le=10)
    coupling_ratio: float = number(unit="1", title="Speed ratio above which it is a fluid coupling", ge=0, le=1)


class Gearbox(Part):
    """Gears from the first upwards, reverse, and their automatic shifting. Lists have one entry for each forward gear."""

    ratios: numbers(unit="1", title="Ratio of each gear", ge=0.1, le=30)
    reverse_ratio: float = number(unit="1", title="Ratio of the reverse gear", ge=0.1, le=30)
    final_ratio: float = number(unit="1", title="Ratio of the final drive", ge=0.1, le=20)
    inertias: numbers(unit="kg m²", title="Inertia at the input, each gear", ge=0, le=10)
    reverse_inertia: float = number(unit="kg m²", title="Inertia at the input, reverse", ge=0, le=10)
    disengage_times: numbers(unit="s", title="Time to open the clutch in each gear", ge=0, le=3)
    open_times: numbers(unit="s", title="Time it stays open to engage each gear", ge=0, le=3)
    engage_times: numbers(unit="s", title="Time to close it in each gear", ge=0, le=5)
    reverse_times: numbers(unit="s", title="Reverse: time to open, open, to close", least=3, most=3, ge=0, le=5)
    up_light: numbers(unit="rad/s", title="Shift up above this speed, pedal just touched", ge=0, le=3000)
    up_full: numbers(unit="rad/s", title="Shift up above this speed, full pedal", ge=0, le=3000)
    down_light: numbers(unit="rad/s", title="Shift down below this speed, pedal just touched", ge=0, le=3000)
    down_full: numbers(unit="rad/s", title="Shift down below this speed, full pedal", ge=0, le=3000)
    loss_torque: float = number(unit="Nm", title="Loss at the input without load", ge=0, le=200)
    loss_share: float = number(unit="1", title="Loss over transmitted torque", ge=0, le=0.4)
    front_share: float = number(unit="1", title="Share of the drive that goes to the front axle (0: rear, 1: front)", ge=0, le=1)

    @model_validator(mode="after")
    def one_of_each(self):
        count = len(self.ratios)
        if count > MOST_GEARS:
            raise ValueError(f"{count} gears; at most {MOST_GEARS}")
        lists = ("inertias", "disengage_times", "open_times", "engage_times", "up_light", "up_full", "down_light", "down_full")
        wrong = [f"{len(getattr(self, name))} {name}" for name in lists if len(getattr(self, name)) != count]
        if wrong:
            raise ValueError(f"{count} ratios, but {', '.join(wrong)}: one for each gear")
        if any(b >= a for a, b in zip(self.ratios, self.ratios[1:], strict=False)):
            raise ValueError("ratios must fall from the first gear to the last")
        self.has_hysteresis()
        return self

    def has_hysteresis(self):
        """After a shift up, the speed in the new gear must lie above that gear's shift down."""
        for gear in range(len(self.ratios) - 1):
            fall = self.ratios[gear + 1] / self.ratios[gear]
            for pedal in ("light", "full"):
                up, down = getattr(self, f"up_{pedal}")[gear], getattr(self, f"down_{pedal}")[gear + 1]
                if up * fall <= down:
                    raise ValueError(
                        f"gears {gear + 1} and {gear + 2} would hunt with {pedal} pedal: shifting up at {up:g} rad/s gives "
                        f"{up * fall:.0f} rad/s, at which down_{pedal} ({down:g} rad/s) shifts down again"
                    )


class Air(Part):
    """Aerodynamics."""

    drag_coefficient: float = number(unit="1", title="Air drag coefficient", ge=0, le=1.5)
    frontal_area: float = number(unit="m²", title="Frontal area", ge=0, le=15)


class Tyres(Part):
    """Property files of the catalogue, or paths relative to the vehicle file; and what a real axle makes of them.

    A tyre was measured on a bench. On a car, compliance of axle and steering takes some of its cornering stiffness away, and the road
    is another one: the scales say how much (the factors LKY, LMUX and LMUY of the Magic Formula), and calibration finds them.
    """

    front: str = Field(..., title="Tyres of the front axle")
    rear: str = Field(..., title="Tyres of the rear axle")
    front_cornering: float = Field(1.0, title="Scale of cornering stiffness, front", json_schema_extra={"unit": "1"}, ge=0.2, le=3)
    rear_cornering: float = Field(1.0, title="Scale of cornering stiffness, rear", json_schema_extra={"unit": "1"}, ge=0.2, le=3)
    front_grip: float = Field(1.0, title="Scale of peak friction, front", json_schema_extra={"unit": "1"}, ge=0.2, le=2)
    rear_grip: float = Field(1.0, title="Scale of peak friction, rear", json_schema_extra={"unit": "1"}, ge=0.2, le=2)


def bounds(*, unit: str, title: str):
    """Lowest and highest value of a quantity."""
    return Field(..., min_length=2, max_length=2, title=title, json_schema_extra={"unit": unit})


class Span(Part):
    """What a vehicle was validated for against recorded drives (studio/validation): outside, nothing is said of it."""

    speed: list[float] = bounds(unit="m/s", title="Speed")
    acceleration: list[float] = bounds(unit="m/s²", title="Longitudinal acceleration")
    lateral_acceleration: list[float] = bounds(unit="m/s²", title="Lateral acceleration")
    yaw_rate: list[float] = bounds(unit="rad/s", title="Yaw rate")

    @model_validator(mode="after")
    def rises(self):
        return refuse(self, *(low > high and f"{name} from {low:g} to {high:g}: the lower bound comes first" for name, (low, high) in self))


class Vehicle(Part):
    """All values of a vehicle."""

    title: str = Field(..., min_length=1, max_length=120, title="Title")
    description: str = Field("", max_length=2000, title="Description")
    licence: str = Field("", max_length=400, title="Licence of the values")
    tyres: Tyres
    body: Body
    suspension: Suspension
    wheels: Wheels
    steering: Steering
    brakes: Brakes
    engine: Engine
    coupling: Coupling
    gearbox: Gearbox
    air: Air
    validated: Span | None = Field(None, title="Validated span")

    @model_validator(mode="after")
    def fits_together(self):
        return refuse(self, *self.couples(), *self.shifts(), *self.stands())

    def couples(self):
        """Engine and coupling belong together."""
        engine, coupling = self.engine, self.coupling
        yield (engine.kind == "combustion" and coupling.kind == "rigid") and (
            "a combustion engine needs a coupling that opens: coupling.kind clutch or converter"
        )
        yield (engine.kind == "combustion" and coupling.kind == "clutch" and not starts(engine, coupling)) and (
            f"coupling.launch_speed {coupling.launch_speed:g} rad/s must lie between the engine's idle speed, "
            f"{engine.idle_speed:g} rad/s, and its limit, {engine.limit_speed:g} rad/s"
        )
        yield (coupling.kind == "converter" and not (coupling.pump[0] > 0 and coupling.turbine[0] > 0)) and (
            "a converter transmits nothing at standstill: the first numbers of coupling.pump and coupling.turbine must be > 0"
        )

    def shifts(self):
        """A gear must be left before the engine reaches its limit, or it never is."""
        for gear, speed in enumerate(self.gearbox.up_full[:-1], start=1):
            yield (speed >= self.engine.limit_speed) and (
                f"gear {gear} shifts up at {speed:g} rad/s, which the engine's limit of {self.engine.limit_speed:g} rad/s forbids"
            )

    def stands(self):
        """The centre of gravity is not below the road, and the springs hold the body upright."""
        body, radius = self.body, self.wheels.radius
        yield (body.gravity_height < radius - 0.2) and (
            f"gravity_height {body.gravity_height:g} m lies far below the wheel centres, {radius:g} m"
        )
        holds, tips = self.roll_stiffness(), body.mass * GRAVITY * body.gravity_height
        yield (holds <= tips) and (
            f"springs and anti-roll bars hold the body with {holds:.0f} Nm/rad, gravity tips it with up to {tips:.0f} Nm/rad"
        )

    def roll_stiffness(self) -> float:
        """Of springs and anti-roll bars together [Nm/rad], wheels standing on the ground."""
        body, springs = self.body, self.suspension
        front = 0.5 * springs.stiffness_front * body.front_track**2 + springs.anti_roll_front
        rear = 0.5 * springs.stiffness_rear * body.rear_track**2 + springs.anti_roll_rear
        return front + rear


def starts(engine: Engine, coupling: Coupling) -> bool:
    """Whether the clutch slips at a speed that the engine can hold."""
    return engine.idle_speed < coupling.launch_speed < engine.limit_speed


@dataclass(frozen=True)
class Origin:
    """Where a value comes from."""

    unit: str
    origin: str
    source: str
    range: tuple[float, float] | None = None


ORIGINS = ("published", "measured", "estimated")
