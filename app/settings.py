"""What the program remembers between runs, apart from documents."""

from pathlib import Path

from PySide6.QtCore import QSettings

MOST_RECENT = 10


class Settings:
    """Typed access to the user's settings file."""

    def __init__(self, store: QSettings | None = None) -> None:
        self._store = store or QSettings(
            QSettings.Format.IniFormat, QSettings.Scope.UserScope, "Inkbetween", "Inkbetween"
        )

    def number(self, key: str, default: float, low: float, high: float) -> float:
        """Return a number kept under `key`, clipped; the default where it is missing or damaged."""
        try:
            return min(max(float(str(self._store.value(key, default))), low), high)
        except ValueError:
            return default

    def flag(self, key: str, default: bool) -> bool:
        return str(self._store.value(key, default)).lower() == "true"

    def text(self, key: str, default: str = "") -> str:
        return str(self._store.value(key, default))

    def blob(self, key: str) -> object:
        return self._store.value(key)

    def keep(self, key: str, value: object) -> None:
        self._store.setValue(key, value)

    def recent_files(self) -> list[Path]:
        """Return the files opened last, the newest first; some may be gone, or on a disk that is not there."""
        kept = self._store.value("recent", [])
        names = [kept] if isinstance(kept, str) else list(kept or [])
        return [Path(str(name)) for name in names]

    def add_recent(self, path: Path) -> None:
        names = [str(path.resolve())]
        names += [str(p) for p in self.recent_files() if str(p) != names[0]]
        self._store.setValue("recent", names[:MOST_RECENT])

    def clear_recent(self) -> None:
        self._store.setValue("recent", [])
