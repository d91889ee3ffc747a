"""What stream_rate.py prints; it is run by hand."""

import pytest
from stream_rate import summary

JPEG = b"\xff\xd8" + bytes(1998)


@pytest.mark.parametrize(("received", "said"), [
    ([[JPEG, JPEG]], "1.0 to 1.0 images/s of 2 kB each"),
    ([[JPEG, {"names": []}, b"points"], []], "0.0 to 0.5 images/s of 2 kB each"),
    ([[], [{"names": []}]], "0.0 to 0.0 images/s of 0 kB each"),  # time stands still
])
def test_the_slowest_and_the_fastest_client_are_told(received, said):
    assert summary(received, 2.0) == said
