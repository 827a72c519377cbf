"""An activity with other words for everything that its file names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tangy_profiles.declared.model import (
    Declaration,
    Effect,
    Expectation,
    Fact,
    FactCondition,
    Habit,
)


def renamed(declaration: Declaration) -> tuple[Declaration, Mapping[str, str]]:
    """Return an activity with new names of facts, stages and behaviours, and a map of names.

    Only built-in names, values, and texts keep their words.
    """
    facts = {
        name: name if fact.built_in else f"fact{number}"
        for number, (name, fact) in enumerate(declaration.facts.items())
    }
    stages = {one.name: f"stage{number}" for number, one in enumerate(declaration.stages)}
    behaviours = {name: f"act {'x' * n}" for n, name in enumerate(declaration.behaviours, 1)}

    def condition(one: FactCondition) -> FactCondition:
        return replace(one, fact=facts[one.fact])

    def conditions(some: tuple[FactCondition, ...]) -> tuple[FactCondition, ...]:
        return tuple(map(condition, some))

    def effect(one: Effect) -> Effect:
        named = facts[one.fact] if one.fact else ""
        return replace(one, fact=named, conditions=conditions(one.conditions))

    def fact(one: Fact) -> Fact:
        tests = tuple((value, conditions(found)) for value, found in one.tests)
        return replace(one, name=facts[one.name], tests=tests)

    def habit(one: Habit) -> Habit:
        return replace(one, fact=facts[one.fact], when=conditions(one.when))

    def expectation(one: Expectation) -> Expectation:
        new = replace(one, stage=stages[one.stage], behaviour=behaviours[one.behaviour])
        return replace(new, conditions=conditions(one.conditions))

    def text(template: str) -> str:
        for old, new in facts.items():
            template = template.replace(f"{{{old}}}", f"{{{new}}}")
            template = template.replace(f"{{{old} of each}}", f"{{{new} of each}}")
        return template

    made = replace(
        declaration,
        facts={facts[name]: fact(one) for name, one in declaration.facts.items()},
        stages=tuple(
            replace(
                one,
                name=stages[one.name],
                when=conditions(one.when),
                sees=tuple(facts[name] for name in one.sees),
            )
            for one in declaration.stages
        ),
        behaviours={
            behaviours[name]: replace(
                one,
                name=behaviours[name],
                effects=tuple(map(effect, one.effects)),
                needs=conditions(one.needs),
                says={way: tuple(map(text, texts)) for way, texts in one.says.items()},
                phrases=(behaviours[name],),
                question=behaviours[name],
                image=text(one.image),
            )
            for name, one in declaration.behaviours.items()
        },
        habits=tuple(map(habit, declaration.habits)),
        expected=tuple(map(expectation, declaration.expected)),
    )
    return made, {new: old for old, new in {**stages, **behaviours}.items()}
