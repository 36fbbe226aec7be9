#include "database.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

namespace nsma {
namespace {

template <class Call>
auto translated(const Call& call) {
    try {
        return call();
    } catch (const SQLite::Exception& error) {
        const bool locked = error.getErrorCode() == 5 || error.getErrorCode() == 6;  // SQLITE_BUSY, SQLITE_LOCKED
        throw DatabaseError(error.getErrorStr(), locked);
    }
}

}  // namespace

struct Database::Implementation {
    Implementation(const std::filesystem::path& file, int flags) : database(file.string(), flags) {}
    SQLite::Database database;
};

Database::Database(const std::filesystem::path& file, bool write) {
    translated([&] {
        const int flags = write ? SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE : SQLite::OPEN_READONLY;
        implementation_ = std::make_unique<Implementation>(file, flags);
    });
    if (!write) return;
    // One writer, no shared memory: also safe on a network file system.
    for (const char* sql : {"PRAGMA locking_mode=EXCLUSIVE", "PRAGMA journal_mode=WAL", "PRAGMA synchronous=NORMAL",
                            "BEGIN EXCLUSIVE", "COMMIT"}) {
        execute(sql);
    }
}

Database::~Database() = default;

void Database::execute(const std::string& sql) {
    translated([&] { implementation_->database.exec(sql); });
}

bool Database::has_table(const std::string& name) const {
    return translated([&] { return implementation_->database.tableExists(name); });
}

void Database::transaction(const std::function<void()>& work) {
    translated([&] {
        SQLite::Transaction transaction(implementation_->database);
        work();
        transaction.commit();
    });
}

struct DatabaseStatement::Implementation {
    Implementation(const SQLite::Database& database, const std::string& sql) : statement(database, sql) {}
    SQLite::Statement statement;
};

DatabaseStatement::DatabaseStatement(Database& database, const std::string& sql)
    : implementation_(
          translated([&] { return std::make_unique<Implementation>(database.implementation_->database, sql); })) {}

DatabaseStatement::~DatabaseStatement() = default;
DatabaseStatement::DatabaseStatement(DatabaseStatement&&) noexcept = default;

void DatabaseStatement::select(std::initializer_list<std::int64_t> keys, const RecordRow& row) {
    translated([&] {
        SQLite::Statement& statement = implementation_->statement;
        statement.reset();
        int place = 0;
        for (const std::int64_t key : keys) statement.bind(++place, key);
        for (const FieldValue& value : row) {
            ++place;
            if (const auto* truth = std::get_if<bool>(&value)) {
                statement.bind(place, *truth ? 1 : 0);
            } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
                statement.bind(place, *whole);
            } else if (const auto* real = std::get_if<double>(&value)) {
                statement.bind(place, *real);
            } else if (const auto* text = std::get_if<std::string>(&value)) {
                statement.bind(place, *text);
            } else {
                statement.bind(place);
            }
        }
    });
}

void DatabaseStatement::insert(std::initializer_list<std::int64_t> keys, const RecordRow& row) {
    select(keys, row);
    translated([&] { implementation_->statement.exec(); });
}

bool DatabaseStatement::step() {
    return translated([&] { return implementation_->statement.executeStep(); });
}

long DatabaseStatement::integer(int column) {
    return translated([&]() -> long { return implementation_->statement.getColumn(column).getInt64(); });
}

std::string DatabaseStatement::text(int column) {
    return translated([&] { return implementation_->statement.getColumn(column).getString(); });
}

RecordRow DatabaseStatement::row(int from) {
    return translated([&] {
        RecordRow row;
        for (int i = from; i < implementation_->statement.getColumnCount(); ++i) {
            const SQLite::Column column = implementation_->statement.getColumn(i);
            if (column.isInteger()) {
                row.emplace_back(column.getInt64());
            } else if (column.isFloat()) {
                row.emplace_back(column.getDouble());
            } else if (column.isText()) {
                row.emplace_back(column.getString());
            } else {
                row.emplace_back();
            }
        }
        return row;
    });
}

}  // namespace nsma
