"""The kinds of event in the log: a closed set, each with a record.

A body is validated when it is written and when it is read. It may have keys that its record does
not define.
"""

from __future__ import annotations

from tangy_profiles import game_records, people_records, staff_records, teaching_records
from tangy_profiles.records import KINDS as KINDS
from tangy_profiles.records import EventRecord as EventRecord
from tangy_profiles.records import Unknown as Unknown
from tangy_profiles.records import read_record as read_record

MODULES = (people_records, teaching_records, game_records, staff_records)
"""Where the records are."""
