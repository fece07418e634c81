"""Packets of 802.11p: time on the air to the microsecond, survival against published figures and between the rates."""

import numpy as np
import pytest

from studio.model.radio import packet


@pytest.mark.parametrize(
    ("size", "rate", "microseconds"),
    [(350, 6, 512), (200, 6, 312), (300, 6, 448), (400, 6, 584), (500, 6, 712), (350, 12, 280), (350, 3, 984)],
)
def test_time_on_the_air(size, rate, microseconds):
    assert 1e6 * packet.airtime(float(size), packet.RATES.index(rate)) == pytest.approx(microseconds, abs=1e-9)


def test_bits_of_a_symbol():
    assert [packet.symbol_bits(rate) for rate in range(8)] == [24, 36, 48, 72, 96, 144, 192, 216]
    assert [packet.symbol_bits(rate) / packet.SYMBOL / 1e6 for rate in range(8)] == pytest.approx(packet.RATES)


@pytest.mark.parametrize(("snr", "survives", "close"), [(5.5, 0.017, 0.005), (6.0, 0.492, 0.005), (7.0, 0.978, 0.005), (8.0, 0.9995, 1e-4)])
def test_survival_of_350_bytes_at_6_megabits(snr, survives, close):
    assert packet.survival(10.0 ** (0.1 * snr), 2800.0, 2) == pytest.approx(survives, abs=close)


def test_service_and_tail_count():
    assert packet.survival(10.0**0.6, 2800.0 + packet.AROUND, 2) == pytest.approx(0.490, abs=0.001)


def needed(rate, bits=2800.0):
    """The ratio [dB] at which half of the packets survive."""
    low, high = -5.0, 40.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if packet.survival(10.0 ** (0.1 * middle), bits, rate) < 0.5 else (low, middle)
    return low


def test_faster_packets_need_more():
    """QPSK 3 dB more than BPSK with the same code, exactly; every step up needs more, except 9 Mbit/s beside 6 and 12 (known)."""
    at = [needed(rate) for rate in range(8)]
    three = 10.0 * np.log10(2.0)
    assert at[2] - at[0] == pytest.approx(three, abs=1e-6) and at[3] - at[1] == pytest.approx(three, abs=1e-6)
    assert at[0] < at[1] and at[2] < at[3] < at[4] < at[5] < at[6] < at[7]


def test_longer_packets_survive_less():
    once, twice = (packet.survival(10.0**0.62, bits, 2) for bits in (2800.0, 5600.0))
    assert twice == pytest.approx(once**2, rel=1e-12)


@pytest.mark.parametrize("rate", range(8))
def test_survival_is_a_probability_that_grows_with_the_ratio(rate):
    found = [packet.survival(10.0 ** (0.1 * snr), 2800.0, rate) for snr in np.arange(-20.0, 45.0, 0.25)]
    assert found[0] == 0.0 and found[-1] == 1.0 and (np.diff(found) >= 0.0).all()


@pytest.mark.parametrize("rate", range(8))
def test_what_is_hopeless_and_what_is_certain(rate):
    """Not one of 1e9 survives or is lost beyond these ratios, of one byte and of the longest frame; in between the draw decides."""
    low, high = packet.HOPELESS[rate], packet.CERTAIN[rate]
    assert packet.survival(10.0 ** (0.1 * low), 30.0, rate) < 1e-9
    assert packet.survival(10.0 ** (0.1 * high), 8.0 * 2304.0 + packet.AROUND, rate) > 1.0 - 1e-9
    worn = packet.worn(rate)
    assert not packet.survives(low - 0.01, rate, 30.0, 1e-12, worn, 0)
    assert packet.survives(high + 0.01, rate, 18_454.0, 1.0 - 1e-12, worn, 0)
    for ratio in np.linspace(low, high, 20):
        share = packet.survival(10.0 ** (0.1 * ratio), 2822.0, rate)
        for draw in (0.1, 0.5, 0.9):
            given = (ratio, rate, 2822.0, draw, worn, 0)
            assert packet.survives(*given) == (share > draw)
            assert packet.surely_survives(*given) <= (share > draw) <= (not packet.surely_fails(*given))


@pytest.mark.parametrize("rate", range(8))
def test_the_table_of_wear_tells_most_packets_fate(rate):
    """It covers all ratios that are neither hopeless nor certain; for one of fifty draws or fewer it does not say enough."""
    worn = packet.worn(rate)
    assert packet.HOPELESS[rate] + (packet.POINTS - 2) * packet.STEP > packet.CERTAIN[rate]
    assert (np.diff(worn) <= 0.0).all()
    ratios, draws = np.arange(packet.HOPELESS[rate], packet.CERTAIN[rate], 0.011), np.linspace(0.01, 0.99, 50)
    given = [(ratio, rate, 2822.0, draw, worn, 0) for ratio in ratios for draw in draws]
    assert np.mean([not packet.surely_survives(*each) and not packet.surely_fails(*each) for each in given]) < 0.02
