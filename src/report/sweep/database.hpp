#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>

#include "study/sweep/record_fields.hpp"

namespace nsma {

/// What SQLite said.
class DatabaseError : public std::runtime_error {
public:
    DatabaseError(const std::string& what, bool locked) : std::runtime_error(what), locked_(locked) {}
    [[nodiscard]] bool locked() const { return locked_; }  ///< another process has the file

private:
    bool locked_;
};

/// One SQLite file; everything here throws DatabaseError.
class Database {
public:
    /// A writer has the file for itself and makes it where it is missing.
    Database(const std::filesystem::path& file, bool write);
    ~Database();

    void execute(const std::string& sql);
    [[nodiscard]] bool has_table(const std::string& name) const;
    /// All of it or nothing.
    void transaction(const std::function<void()>& work);

private:
    friend class DatabaseStatement;
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// A statement that runs again and again; must not outlive its database.
class DatabaseStatement {
public:
    DatabaseStatement(Database& database, const std::string& sql);
    ~DatabaseStatement();
    DatabaseStatement(DatabaseStatement&&) noexcept;

    /// Runs with these parameters, keys first.
    void insert(std::initializer_list<std::int64_t> keys, const RecordRow& row);
    /// Asks for the rows of these parameters; step() moves to the next one, false: there is none.
    void select(std::initializer_list<std::int64_t> keys, const RecordRow& row = {});
    bool step();
    [[nodiscard]] long integer(int column);
    [[nodiscard]] std::string text(int column);
    [[nodiscard]] RecordRow row(int from);  ///< the values from a column on

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace nsma
